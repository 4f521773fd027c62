"""Why a simulation and a measurement disagree: where the gap lies, which effect causes it, how far it shrinks.

bench        what is known before measuring: scene, uncertainty of its parameters, channels with their noise
trial        one record laid beside the scene that is to reproduce it
noise        whitening of residuals
unknowns     scales on which parameters are searched
hypothesis   scene + effects that are tried + parameters that are let loose
simulator    many parameter sets of a hypothesis -> residuals
fit          damped Gauss-Newton with priors
candidates   effects and places that are tried
"""
