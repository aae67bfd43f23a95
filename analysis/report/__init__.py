"""``atoll report``: a run as one HTML file that asks nothing of the network."""

from analysis.report.write import write_report

__all__ = ["write_report"]
