"""What each law of the library costs in a compiled run."""
