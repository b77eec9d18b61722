# Error against number of sensors, read from a results database with pandas and drawn with matplotlib. Cell by cell
# (# %%) in an editor that knows notebooks, or at once: python3 plot_errors.py capstan.db errors.png
# %% Where the numbers are
import sqlite3
import sys

import matplotlib

matplotlib.use("Agg")  # a picture, no window; leave out in a notebook
import matplotlib.pyplot as plt
import pandas as pd

database, picture = sys.argv[1], sys.argv[2]
connection = sqlite3.connect(f"file:{database}?mode=ro", uri=True)

# %% Error of each layout and method, with its 95% interval
errors = pd.read_sql(
    """SELECT regime, noise, family, sensor_count, method_title, mean_abs_error_N, interval_low_N, interval_high_N
       FROM v_error_by_layout WHERE knowledge <> 'direction_known' AND study_id = (SELECT max(study_id) FROM study)""",
    connection)
print(errors.pivot_table(index=["regime", "method_title"], columns="sensor_count", values="mean_abs_error_N", aggfunc="min")
      .round(3))

# %% The best family of each method, one panel a regime
best = errors.sort_values("mean_abs_error_N").groupby(["regime", "noise", "method_title", "sensor_count"]).head(1)
noise = best["noise"].iloc[0]
regimes = sorted(best["regime"].unique())
figure, panels = plt.subplots(1, len(regimes), figsize=(6 * len(regimes), 4), squeeze=False, sharey=True)
for panel, regime in zip(panels[0], regimes):
    for method, rows in best[(best["regime"] == regime) & (best["noise"] == noise)].groupby("method_title"):
        rows = rows.sort_values("sensor_count")
        panel.plot(rows["sensor_count"], rows["mean_abs_error_N"], marker="o", label=method)
        panel.fill_between(rows["sensor_count"], rows["interval_low_N"], rows["interval_high_N"], alpha=0.2)
    panel.set(title=f"{regime}, {noise}", xlabel="number of sensors", ylim=(0, None))
panels[0][0].set_ylabel("mean tension error [N]")
panels[0][-1].legend(frameon=False)
figure.savefig(picture, bbox_inches="tight", dpi=120)

# %% Which nodes to equip
print(pd.read_sql("SELECT scope, regime, noise, nodes, method_title, error_N FROM v_recommendation", connection).to_string())
