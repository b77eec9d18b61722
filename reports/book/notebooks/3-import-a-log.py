# %% [markdown]
# # Import a MATLAB file or a bag
#
# A laboratory's log becomes a recording: columns get their channels, units and signs, and every repair is listed. Here a MATLAB file that the program writes stands for
# a log of your own; a bag, MCAP, HDF5 or delimited text goes the same way.

# %%
import subprocess
from pathlib import Path

import matplotlib.pyplot as plt

import capstan as cp

subprocess.run(["capstan", "simulate", "configs/bench-grip.toml", "--sensor-noise", "0.002", "-o", "run7.mat"], check=True)
print(subprocess.run(["capstan", "import", "--list", "run7.mat"], check=True, capture_output=True, text=True).stdout)

# %% [markdown]
# A mapping says which column is which channel. The program proposes one with its reasons and doubts; read it and correct it.

# %%
subprocess.run(["capstan", "import", "--suggest", "run7.mat", "-o", "import.toml"], check=True)
print(Path("import.toml").read_text())

# %%
recording = cp.read_recording("run7.mat", mapping="import.toml")
print(recording)
print("repairs:", recording.repairs)
print("doubts:", recording.doubts)

# %%
run = recording.runs[0]
figure, (above, below) = plt.subplots(2, 1, sharex=True)
above.plot(run.time_s, run["motor_angle"], label="motor")
above.plot(run.time_s, run["load_angle"], label="load")
above.set_ylabel("angle [rad]")
above.legend()
below.plot(run.time_s, run["motor_torque"], label="motor")
below.plot(run.time_s, run["load_torque"], label="load")
below.set_ylabel("torque [N m]")
below.set_xlabel("time [s]")
plt.show()
