#include "capstan/storage/report_queries.h"

namespace capstan::storage {

const std::string_view compared_errors_query = R"sql(
WITH one AS (SELECT * FROM v_error_by_layout WHERE study_id = ?1),
other AS (SELECT * FROM v_error_by_layout WHERE study_id = ?2),
both AS (
    SELECT a.regime, a.noise, a.family, a.sensor_count, a.method, a.method_title,
           a.mean_abs_error_N AS first_error_N, b.mean_abs_error_N AS second_error_N,
           b.mean_abs_error_N - a.mean_abs_error_N AS difference_N,
           1.959963984540054 * sqrt(a.standard_error_N * a.standard_error_N + b.standard_error_N * b.standard_error_N) AS half_N
    FROM one a JOIN other b USING (regime, noise, family, sensor_count, method))
SELECT regime, noise, family, sensor_count, method, method_title, first_error_N, second_error_N, difference_N,
       difference_N - half_N AS interval_low_N, difference_N + half_N AS interval_high_N
FROM both ORDER BY regime, noise, family, method, sensor_count)sql";

const std::string_view compared_best_query = R"sql(
WITH ranked AS (
    SELECT *, row_number() OVER (PARTITION BY study_id, regime, noise, sensor_count ORDER BY mean_abs_error_N, method) AS place
    FROM v_best_method WHERE study_id IN (?1, ?2))
SELECT regime || ', ' || noise AS question, CASE study_id WHEN ?1 THEN 'first' ELSE 'second' END AS series, sensor_count,
       family, method_title, mean_abs_error_N AS error_N, interval_low_N, interval_high_N
FROM ranked WHERE place = 1 ORDER BY question, series, sensor_count)sql";

const std::string_view compared_recommendations_query = R"sql(
SELECT CASE study_id WHEN ?1 THEN 'first' ELSE 'second' END AS series, scope, regime, noise, nodes, sensor_count,
       method_title, error_N, interval_low_N, interval_high_N
FROM v_recommendation WHERE study_id IN (?1, ?2)
ORDER BY scope, regime, noise, series)sql";

}  // namespace capstan::storage
