/* A controller in C99 that estimates the tension along a cable at 1 kHz from the motor's position and two load cells, and
 * prints how long its updates took: observe_at_1_kHz [SECONDS]. A cable that follows a sine stands for the rig. */
#define _POSIX_C_SOURCE 200809L
#include <capstan/controller/capstan_observer.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { SEGMENTS = 12, NODES = SEGMENTS + 1 };

static double now_us(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return 1e6 * (double)now.tv_sec + 1e-3 * (double)now.tv_nsec;
}

/* Until the next millisecond since the start. */
static void wait_for_sample(const struct timespec* start, long sample) {
    struct timespec due = *start;
    due.tv_sec += sample / 1000;
    due.tv_nsec += sample % 1000 * 1000000L;
    if (due.tv_nsec >= 1000000000L) {
        due.tv_nsec -= 1000000000L;
        due.tv_sec += 1;
    }
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, NULL);
}

int main(int count, char** arguments) {
    const capstan_bend bend = {3.14159265358979, 0.1, 0.3};
    const capstan_cable cable = {1.2, &bend, 1, 9e3, 0.1, 0.1, 20.0, SEGMENTS};
    const capstan_sensor sensors[] = {{CAPSTAN_TENSION, 0.0}, {CAPSTAN_TENSION, 1.2}};
    capstan_observer_settings settings = capstan_observer_defaults();
    settings.noise_N = 0.3;
    settings.load_wander_m = 2e-5;

    void* storage = malloc(capstan_observer_bytes());
    char message[500];
    capstan_observer* observer = NULL;
    const capstan_status made = capstan_observer_create(storage, capstan_observer_bytes(), &cable, sensors, 2,
                                                        &settings, message, sizeof message, &observer);
    if (made != CAPSTAN_OK) {
        fprintf(stderr, "%s\n%s\n", capstan_status_words(made), message);
        return 1;
    }

    const long samples = 1000L * (count > 1 ? atol(arguments[1]) : 2);
    double mean_N[NODES], low_N[NODES], high_N[NODES], worst_us = 0.0, sum_us = 0.0;
    struct timespec start;
    clock_gettime(CLOCK_MONOTONIC, &start);
    for (long sample = 1; sample <= samples; ++sample) {
        wait_for_sample(&start, sample);
        const double reeled_m = 0.002 * (1.0 - cos(6.28 * (double)sample / 1000.0));
        const double readings[] = {reeled_m, 20.0 + 9e3 / 1.2 * reeled_m, 20.0 + 7e3 / 1.2 * reeled_m};
        const double began_us = now_us();
        const capstan_status status =
            capstan_observer_update(observer, (double)sample / 1000.0, readings, mean_N, low_N, high_N);
        const double took_us = now_us() - began_us;
        if (status != CAPSTAN_OK) {
            fprintf(stderr, "sample %ld: %s\n", sample, capstan_status_words(status));
            return 1;
        }
        sum_us += took_us;
        if (took_us > worst_us) worst_us = took_us;
    }
    printf("%ld updates at 1 kHz, %d nodes, %d members: mean %.1f us, worst %.1f us\n", samples,
           capstan_observer_nodes(observer), settings.members, sum_us / (double)samples, worst_us);
    printf("tension at the load: %.2f N, 95%% band %.2f to %.2f N\n", mean_N[NODES - 1], low_N[NODES - 1],
           high_N[NODES - 1]);
    capstan_observer_destroy(observer);
    free(storage);
    return 0;
}
