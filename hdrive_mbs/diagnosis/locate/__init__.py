"""Where an unknown force or error sits, without knowing its law.

sources       places where a force may act, as generalized forces
motion        the run that everything is linearised about
linear        A, B, C, D along a motion, and transfers
observer      residuals of rotors without the vibration that goes on by itself
line          a trial's network linearised, with its places
spectra       residuals and their slopes as short-time spectra
response      what a force at each place does to the columns
likelihood    how likely the residuals are with a force at one place
about         a model linearised, with the likelihood of forces at all places
locate        all places compared
latent_force  the course of the force
"""

from hdrive_mbs.diagnosis.locate.latent_force import LatentForce
from hdrive_mbs.diagnosis.locate.locate import Localiser, locate

__all__ = ["LatentForce", "Localiser", "locate"]
