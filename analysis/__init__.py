"""Reading logs: charts, sheets of forms, reports. Nothing here changes a run."""
