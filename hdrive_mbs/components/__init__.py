"""Parts of a scene, one file each: immutable data that know how to enter a network."""
