"""The practice page: one HTML file in which the dancer plays a chart and waits for whoever learns it."""
