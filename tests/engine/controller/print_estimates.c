/* Prints every bit of what the observer estimates from fixed readings, for tests/python/test_same_bits.py. */
#include <capstan/controller/capstan_observer.h>
#include <stdio.h>

static union {
    double aligned;
    char bytes[4096];
} storage;

int main(void) {
    const capstan_bend bends[] = {{90.0 * (3.14159265358979323846 / 180.0), 0.08, 0.2}, {120.0 * (3.14159265358979323846 / 180.0), 0.1, 0.6}};
    const capstan_cable cable = {1.2, bends, 2, 9e3, 0.12, 0.15, 20.0, 12};
    const capstan_sensor sensors[] = {{CAPSTAN_TENSION, 0.05}, {CAPSTAN_LOAD_DISPLACEMENT, 0.0}, {CAPSTAN_TENSION, 1.2}};
    capstan_observer_settings settings = capstan_observer_defaults();
    capstan_observer* observer = NULL;
    char message[400];
    double mean_N[13], low_N[13], high_N[13];
    int sample, node;
    settings.noise_N = 0.25;
    if (capstan_observer_create(&storage, sizeof storage, &cable, sensors, 3, &settings, message, sizeof message,
                                &observer) != CAPSTAN_OK) {
        fprintf(stderr, "%s\n", message);
        return 1;
    }
    for (sample = 1; sample <= 200; ++sample) {
        const double turn = (sample % 100) / 100.0;
        const double readings[] = {0.003 * turn * (1.0 - turn), 20.0 + 30.0 * turn * (1.0 - turn), 0.0002 * turn, 19.0 + 12.0 * turn};
        if (capstan_observer_update(observer, sample / 500.0, readings, mean_N, low_N, high_N) != CAPSTAN_OK) return 1;
        for (node = 0; node < 13; ++node) printf("%a %a %a\n", mean_N[node], low_N[node], high_N[node]);
    }
    capstan_observer_destroy(observer);
    return 0;
}
