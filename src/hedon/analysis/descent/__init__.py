"""Pedigrees, and the genes that would result from descent without selection."""
