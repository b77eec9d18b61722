# %% [markdown]
# # Sweep friction in batch
#
# A thousand cables side by side: how do friction and pretension decide what reaches the load? One call simulates all draws on all processors.

# %%
import matplotlib.pyplot as plt
import numpy as np

import capstan as cp

cable = cp.Cable(length_m=2.0, bends=[cp.Bend(90, 0.08, 0.6), cp.Bend(120, 0.1, 1.2)], axial_stiffness_N=9e3, friction=0.12,
                 pretension_N=20.0, segments=40)
rng = np.random.default_rng(3)
friction = rng.uniform(0.02, 0.3, size=1000)
stroke_m = 0.008 * (1 - np.cos(np.linspace(0.0, 4.0 * np.pi, 400)))
path = cable.simulate(motor_m=stroke_m, load=cp.Spring(3000.0), friction=friction)
path

# %% [markdown]
# What reaches the load at full stroke, against the capstan equation (E1) for a cable that slides everywhere:

# %%
peak = path.tension_N[:, 300]  # the second full stroke
ratio = peak[:, -1] / peak[:, 0]
wrap_rad = np.deg2rad(90 + 120)
figure, axes = plt.subplots()
axes.plot(friction, ratio, ".", ms=3, label="simulated")
order = np.sort(friction)
axes.plot(order, np.exp(-order * wrap_rad), label="capstan equation")
axes.set_xlabel("friction coefficient")
axes.set_ylabel("tension at the load / at the motor")
axes.legend()
plt.show()

# %% [markdown]
# The work that friction takes in a cycle is the area of the loop at the motor less that at the load.

# %%
cycle = slice(200, 400)
motor_J = np.trapz(path.tension_N[:, cycle, 0], stroke_m[cycle], axis=1)
load_J = -np.trapz(path.tension_N[:, cycle, -1], path.displacement_m[:, cycle, -1], axis=1)
figure, axes = plt.subplots()
axes.plot(friction, motor_J - load_J, ".", ms=3)
axes.set_xlabel("friction coefficient")
axes.set_ylabel("loss per cycle [J]")
plt.show()
