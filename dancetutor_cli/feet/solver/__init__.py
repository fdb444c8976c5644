"""The solver: cost preset -> transition tables -> dynamic programme -> Play (who steps what, and what it costs)."""
