"""A scene's equations as machine code: thousands of runs of one structure with changing numbers.

program    recorded equations -> structure, constants and tables
llvm_code  structure -> LLVM text
machine    LLVM text -> functions, kept by structure
line       a network ready to be run with fixed-step Runge-Kutta

For searching and fitting; what is found is verified on the engine.
"""
