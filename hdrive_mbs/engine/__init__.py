"""The engine room: the only importer of exudyn.

assembly      network -> Exudyn system
lowering      law -> native connector, symbolic or Python user function, guarded
solvers       settings of the time integrators
simulation    one run: progress, cancel, checks
linearisation mass, damping and stiffness matrix at a state
"""
