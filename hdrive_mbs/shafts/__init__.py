"""Matrices of shaft sections and what is condensed from them: geometry and numbers, no dynamics."""
