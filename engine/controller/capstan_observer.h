#ifndef CAPSTAN_CONTROLLER_CAPSTAN_OBSERVER_H
#define CAPSTAN_CONTROLLER_CAPSTAN_OBSERVER_H
/* The tension along a cable for a controller in C (C99): the observer of the library, E36 to E38 and E41 of
 * its equations.
 *
 * The caller owns the storage. Creating an observer allocates what it needs and may take milliseconds; an
 * update allocates nothing, locks nothing and raises no exception, and its time depends on the number of
 * nodes, members and sensors alone. Observers are independent of each other; one observer is used by one
 * thread at a time. Link with the component capstan::controller of find_package(capstan), which needs the C++
 * runtime. */

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A bend of the conduit: its angle, its radius, and where it begins, from the motor. */
typedef struct capstan_bend {
    double angle_rad;
    double radius_m;
    double at_m;
} capstan_bend;

/** A cable in its conduit, cut into segments of equal length; its nodes are one more. */
typedef struct capstan_cable {
    double length_m;
    const capstan_bend* bends; /**< bend_count; may be NULL where that is 0 */
    size_t bend_count;
    double axial_stiffness_N; /**< EA: force per unit strain */
    double friction;          /**< of a sliding cable */
    double static_friction;   /**< of one about to slide; at least friction */
    double pretension_N;
    int segments;
} capstan_cable;

typedef enum capstan_sensor_kind {
    CAPSTAN_TENSION = 0,          /**< the tension at place_m [N] */
    CAPSTAN_LOAD_DISPLACEMENT = 1 /**< by how much the load end has moved, positive away from the motor [m] */
} capstan_sensor_kind;

typedef struct capstan_sensor {
    capstan_sensor_kind kind;
    double place_m; /**< from the motor */
} capstan_sensor;

typedef struct capstan_observer_settings {
    double noise_N;        /**< standard deviation of a tension reading; above 0 */
    double load_wander_m;  /**< by how much the load end moves in a sample beyond what is known of it */
    double motor_wander_m; /**< the same of the motor's end */
    int members;           /**< a power of two from 8 to 1024 */
    uint64_t seed;
    /* Friction that depends on the sliding speed v (E20, E21, E41). With a drag an update takes twice as
     * long. */
    double drag_N_s_per_m2; /**< a drag of this times v on each metre of cable; 0: none */
    double extra_friction;  /**< the friction is higher by this times exp(-(v / speed_m_per_s)^2); 0: none */
    double speed_m_per_s;   /**< above 0 with extra_friction */
    double memory_s;        /**< time constant of the low-pass of v in that law; 0 or more */
} capstan_observer_settings;

typedef enum capstan_status {
    CAPSTAN_OK = 0,
    CAPSTAN_NULL_ARGUMENT = 1,     /**< a pointer that is needed is NULL */
    CAPSTAN_STORAGE_TOO_SMALL = 2, /**< or not aligned as malloc aligns */
    CAPSTAN_WRONG_INPUT = 3,       /**< the message says what is wrong with cable, sensors or settings */
    CAPSTAN_OUT_OF_MEMORY = 4,
    CAPSTAN_TIME_NOT_RISING = 5,    /**< the time is not a number above the last one; nothing was changed */
    CAPSTAN_READING_NOT_FINITE = 6, /**< or not below 1e9; nothing was changed */
    CAPSTAN_INTERNAL_ERROR = 7      /**< please report it */
} capstan_status;

typedef struct capstan_observer capstan_observer;

/** Settings with the library's defaults; noise_N has none. */
capstan_observer_settings capstan_observer_defaults(void);

/** How many bytes of storage an observer takes. */
size_t capstan_observer_bytes(void);

/** Makes an observer of a cable at rest under its pretension, in `storage`, and gives it in `observer`.
 * `storage` has at least capstan_observer_bytes() bytes, aligned as malloc aligns. With CAPSTAN_WRONG_INPUT
 * `message` has every problem, cut off at message_bytes; it may be NULL. */
capstan_status capstan_observer_create(void* storage, size_t storage_bytes, const capstan_cable* cable,
                                       const capstan_sensor* sensors, size_t sensor_count,
                                       const capstan_observer_settings* settings, char* message,
                                       size_t message_bytes, capstan_observer** observer);

/** Frees what the observer allocated; the storage remains the caller's. NULL does nothing. */
void capstan_observer_destroy(capstan_observer* observer);

/** How many nodes the cable has. */
int capstan_observer_nodes(const capstan_observer* observer);

/** One sample later. `readings`: how much cable the motor has reeled in since the start [m; positive pulls],
 * then one of each sensor. Samples come at a constant rate, as the wanders are those of a sample; the times
 * give the sliding speed, and those that do not rise are refused. Writes the mean and the limits of the 95%
 * band at every node [N]; each may be NULL. */
capstan_status capstan_observer_update(capstan_observer* observer, double time_s, const double* readings,
                                       double* mean_N, double* low_N, double* high_N);

/** What a status means, in English. */
const char* capstan_status_words(capstan_status status);

#ifdef __cplusplus
}
#endif
#endif
