"""The equations of a scene as plain data: bodies, prescribed motions, states and elements.

A network knows nothing of any engine.  Coordinates count *forward*: positive in the sense in
which the place turns when the motor turns positively, so all angles of a train grow together.
"""
