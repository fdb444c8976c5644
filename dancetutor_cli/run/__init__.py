"""What every room stands on: errors, files, bounded reading, YAML by schema, worker processes, compiled kernels."""
