"""What a run prints: text, JSON, CSV, SARIF and other formats, the page of a pack, the chart sheet."""
