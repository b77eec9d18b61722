# %% [markdown]
# # An observer on recorded data
#
# The tension along a cable while it moves, from two sensors. Here the cable is simulated, so that the truth is known; with a rig the readings come from a recording or a
# control loop.

# %%
import time

import matplotlib.pyplot as plt
import numpy as np

import capstan as cp

cable = cp.Cable(length_m=1.2, bends=[cp.Bend(180, 0.1, 0.3)], axial_stiffness_N=9e3, friction=0.1, pretension_N=20.0, segments=12)
time_s = np.arange(1, 1001) / 500.0
motor_m = 0.004 * (1 - np.cos(2 * np.pi * time_s))
load_m = -0.001 * np.sin(2 * np.pi * 0.8 * time_s)
truth = cable.simulate(motor_m=motor_m, load=cp.Moved(load_m))
truth

# %% [markdown]
# The readings: how much the motor has reeled in, a load cell at the motor, and one at 0.8 m. Nobody measures the load's motion.

# %%
rng = np.random.default_rng(2)
noise_N = 0.3
places = [0.0, 0.8]
nodes = [int(np.argmin(abs(cable.places_m - place))) for place in places]
cells = truth.tension_N[0][:, nodes] + noise_N * rng.standard_normal((time_s.size, 2))

observer = cp.Observer(cable, sensors=[("tension", place) for place in places], noise_N=noise_N, load_wander_m=2e-5)
began = time.perf_counter()
estimate = np.array([observer.update(t, [motor, *pair]) for t, motor, pair in zip(time_s, motor_m, cells)])  # times x (mean, low, high) x nodes
took_us = (time.perf_counter() - began) / time_s.size * 1e6

# %%
end = truth.tension_N[0][:, -1]
figure, axes = plt.subplots()
axes.fill_between(time_s, estimate[:, 1, -1], estimate[:, 2, -1], alpha=0.3, label="95% band")
axes.plot(time_s, estimate[:, 0, -1], lw=1, label="estimate")
axes.plot(time_s, end, lw=1, label="truth")
axes.set_xlabel("time [s]")
axes.set_ylabel("tension at the load [N]")
axes.legend()
plt.show()

# %%
error_N = estimate[:, 0, :] - truth.tension_N[0]
inside = np.mean((estimate[:, 1, :] <= truth.tension_N[0]) & (truth.tension_N[0] <= estimate[:, 2, :]))
print(f"RMS error over all nodes {np.sqrt(np.mean(error_N**2)):.2f} N; the band holds the truth in {100 * inside:.0f}%")
assert took_us < 1e5  # on a controller it is microseconds: see the page on controllers
