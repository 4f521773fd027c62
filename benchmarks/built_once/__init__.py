"""Lines of many parameter sets: each built and recorded, and all from one template."""
