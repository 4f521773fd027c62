"""How a sweep scales with workers."""
