"""The command line: thin; every command reads a scene, calls one analysis and writes its result."""
