"""From phenotype to scores: one criterion a file, and how scores become one fitness."""
