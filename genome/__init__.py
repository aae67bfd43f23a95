"""What is inherited: genotypes, their variation, and the grammars that turn them into text. No geometry."""
