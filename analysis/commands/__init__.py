"""The commands that read logs; ``atoll`` finds them by name."""
