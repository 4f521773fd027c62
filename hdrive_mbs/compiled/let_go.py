"""What compiled runs keep for later ones in the same process, let go."""

from __future__ import annotations

from hdrive_mbs.compiled import constant_mass, linear_forces, machine, springs, structure, time_inputs


def let_go() -> None:
    """Forget machine code, plans of equations, what was made of matrices, and columns of time.

    What is in use stays until its user is gone; what is asked for again is made again, machine code from the cache folder.  For a process
    that from now on leaves the runs to others: columns of time alone may take ``time_inputs.KEPT_BYTES``.
    """
    machine.machine.cache_clear()
    structure.shaped.cache_clear()
    constant_mass.forget()
    linear_forces.forget()
    springs.forget()
    time_inputs.forget()
