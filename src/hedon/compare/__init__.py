"""Comparisons of worlds from any source: contrasts, power, response curves and maps."""
