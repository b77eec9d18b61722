# %% [markdown]
# # Why my log disagrees
#
# A recording of a bench does not follow its model. Which cause is it, and does the corrected model predict runs that it did not see?
# Replace the file by a recording of your own.

# %%
import matplotlib.pyplot as plt

import capstan as cp

recording = cp.read_recording("configs/recordings/viscous-pair.csv")
recording

# %% [markdown]
# The loop of each run, load torque over load angle. The fast run has wider loops than the slow one; friction that does not know speed cannot do that.

# %%
figure, axes = plt.subplots()
for run in recording.runs:
    axes.plot(run["load_angle"], run["load_torque"], lw=1, label=f"run {run.number}")
axes.set_xlabel("load angle [rad]")
axes.set_ylabel("load torque [N m]")
axes.legend()
plt.show()

# %% [markdown]
# The diagnosis fits every known cause to run 2, in which the hand moves fast, and is judged on run 1.

# %%
found = cp.diagnose(recording, fit_runs=[2], hold_runs=[1])
print(found.headline)
for cause in found.causes:
    print(cause.effect, f"{cause.probability:.2f}", {name: number.value for name, number in cause.numbers.items()})

# %%
found.closed

# %% [markdown]
# If several explanations compete, `next_experiment` names the recording to make next. Here it is `None` where one explanation leads clearly.

# %%
print(found.next_experiment)

# %% [markdown]
# What was found is a model of the bench, which is kept in a file and predicts other runs.

# %%
model = found.model
model.save("model.toml")
print(cp.read_model("model.toml").predict(recording, runs=[1]).headline)
