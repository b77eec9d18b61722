# %% [markdown]
# # Place sensors on my cable
#
# Where should tension sensors go on a cable whose friction is known only roughly? Change the numbers of your cable in the first cell and run the rest.

# %%
import matplotlib.pyplot as plt
import numpy as np

import capstan as cp

cable = cp.Cable(
    length_m=1.2,
    bends=[cp.Bend(angle_deg=95, radius_m=0.12, at_m=0.3), cp.Bend(angle_deg=105, radius_m=0.08, at_m=0.8)],
    axial_stiffness_N=9000.0, friction=0.12, pretension_N=15.0, segments=40,
)
cable

# %% [markdown]
# First look at what friction does. Two hundred cables, each with its own friction coefficient, pull on a spring.

# %%
rng = np.random.default_rng(1)
friction = 0.12 * (1 + 0.1 * rng.standard_normal(200))
time_s = np.linspace(0.0, 2.0, 200)
stroke_m = 0.004 * np.sin(2 * np.pi * 0.7 * time_s)
path = cable.simulate(motor_m=stroke_m, load=cp.Spring(3000.0), friction=friction)
middle, spread = path.tension_N.mean(axis=0), path.tension_N.std(axis=0)

# %%
figure, axes = plt.subplots()
for sample in (40, 100, 140):
    axes.plot(path.places_m, middle[sample], label=f"{time_s[sample]:.1f} s")
    axes.fill_between(path.places_m, middle[sample] - 2 * spread[sample], middle[sample] + 2 * spread[sample], alpha=0.2)
axes.set_xlabel("place from the motor [m]")
axes.set_ylabel("tension [N]")
axes.legend()
plt.show()

# %% [markdown]
# Now the search: which set of sensors gives the smallest expected error over all cables that this one could be? A configuration states the
# cable, its uncertainty and what can be bought. `configs/wrist-exosuit.toml` is a commented example.

# %%
answer = cp.place("configs/wrist-exosuit.toml", repetitions=60)
print(answer.headline)

# %% [markdown]
# All numbers of the answer are in `values`. The error against the price, with the range that holds it in 95% of the worlds:

# %%
prices = answer.values["prices"]
figure, axes = plt.subplots()
price = [each["price"] for each in prices]
axes.plot(price, [each["expected_error_N"] for each in prices], "o-", label="expected")
axes.plot(price, [each["error_95_N"] for each in prices], "s--", label="95% of the worlds stay below")
axes.set_xlabel("price (sensors)")
axes.set_ylabel("tension error [N]")
axes.legend()
plt.show()

# %%
for each in prices:
    print(f"{each['price']:4.0f}  {each['expected_error_N']:.3f} N  {each['set']}")
