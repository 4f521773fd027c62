"""Linearised rotor lines: whirl, Campbell diagrams, critical speeds, models of bearings."""
