"""How hard a chart plays: meters estimated from what the feet do, with a bill; see docs/meter.md."""
