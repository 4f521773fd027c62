"""Measured records: read, checked, repaired visibly, resampled, split and brought to one clock."""
