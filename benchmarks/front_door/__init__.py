"""What a new user waits for: import, demo, size of its page."""
