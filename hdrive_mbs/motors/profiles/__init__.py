"""Speeds as functions of time, one file each.  A user's own subclasses SpeedProfile."""
