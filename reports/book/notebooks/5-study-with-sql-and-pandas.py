# %% [markdown]
# # A study, SQL and pandas
#
# A study of sensor placement writes a database of results. Questions to it are one line of SQL or one table of pandas.

# %%
import matplotlib.pyplot as plt

import capstan as cp

study = cp.Study("configs/paper.toml").run(db="results.db", repetitions=300)
print(study.recommend().headline)

# %%
best = study.frame("v_best_method")
best[["regime", "family", "sensor_count", "method_title", "mean_abs_error_N"]].head(8).round(3)

# %% [markdown]
# The error of each fusion method against the number of sensors, averaged over the layouts:

# %%
errors = study.frame("v_error_by_layout")
table = errors[errors.regime == "mass"].pivot_table(index="sensor_count", columns="method_title", values="mean_abs_error_N")
table.round(3)

# %%
axes = table.plot(ylabel="mean error [N]", xlabel="number of sensors", logy=True, figsize=(8, 3.6))
axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
plt.show()

# %% [markdown]
# Any SELECT works; nothing can change the database.

# %%
columns, rows = study.query("""
    SELECT regime, sensor_node, round(avg(mean_abs_error_N), 3) AS error_N
    FROM v_single_sensor_matrix WHERE knowledge = 'direction_unknown' GROUP BY regime, sensor_node ORDER BY error_N LIMIT 5""")
print(columns, *rows, sep="\n")
