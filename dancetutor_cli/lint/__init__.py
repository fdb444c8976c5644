"""Findings: a file per rule, what rules ask of a chart, configuration, baseline, suggestions and fixes, and meters."""
