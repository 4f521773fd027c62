"""How long a test waits for another process where no time is judged."""

PATIENCE = 900.0
"""Seconds after which it hangs, surely: on a machine with other work to do, seconds become minutes."""
