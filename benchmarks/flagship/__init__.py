"""Records of the robot joint line with a planted effect, made by a plant of its own, and what the diagnosis says of them."""
