"""Uses the installed Python package and nothing else of this repository: use_python_package.py RECORDING"""

import sys

import numpy as np

import capstan as cp

cable = cp.Cable(length_m=2.0, bends=[cp.Bend(90, 0.08, 0.6)], axial_stiffness_N=9e3, friction=0.12)
path = cable.simulate(motor_m=0.01 * (1 - np.cos(np.linspace(0, 6, 100))), load=cp.Spring(3000.0), friction=[0.1, 0.2])
found = cp.diagnose(sys.argv[1])
print(cp.__version__, cp.__file__, path, repr(found), sep="\n")
assert path.tension_N.shape == (2, 100, 41)
assert [cause.effect for cause in found.causes] == ["viscous_friction"]
