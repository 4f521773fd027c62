"""Which record to take next, so that causes that look alike so far can be told apart.

plan           a record that has not been taken yet: what drives the bench, how long, how often sampled
drives         what the inputs of a bench are: speed references, motor torques, loads
limits         how fast and how hard a bench may be driven
detectability  how far apart the records of two fitted models would be, parameters adapted, in noise units
multisine      sums of sines with small peaks
menu           plans that make sense for a bench
rotor_menu     the same for a rotor line
within         plans made as large as the limits allow
optimise       a multisine shaped for two given causes
choose         which plan of a menu separates a group best
"""
