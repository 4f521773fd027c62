"""Campaigns: one function over many parameter points, on the processes of this machine or on a cluster."""
