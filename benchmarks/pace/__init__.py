"""What slowed vibrations save a search on rotor lines, and what they cost."""
