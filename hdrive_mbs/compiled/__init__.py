"""A scene's equations as machine code: thousands of runs of one structure with changing numbers.

equations    a network's rates as expressions
  rotor_equations  those of rotor lines, from linear_forces (of matrices, as springs) and constant_mass
readings     channels as expressions, also those that need accelerations
program      recorded equations -> structure, constants, tables and inputs
structure    what they compute, without the numbers
time_inputs  tables of time, evaluated once for all runs that share them
llvm_code    structure -> LLVM text, on one lane or on several side by side in vector registers
machine      LLVM text -> functions, kept by structure
lanes        programs of one structure in memory, and their runs
line         networks ready to be run with fixed-step Runge-Kutta, one or many
step_limit   the longest stable step, and idle_coordinates, which often set it without need
slowed       vibrations that are too fast for a step, slowed down

For searching and fitting; what is found is verified on the engine.
"""
