#pragma once

#include "capstan/effects/backlash.h"
#include "capstan/effects/bending_stiffness.h"
#include "capstan/effects/cable_stiffness_nonlinear.h"
#include "capstan/effects/conduit_compliance.h"
#include "capstan/effects/creep.h"
#include "capstan/effects/environment_coupling.h"
#include "capstan/effects/inertia.h"
#include "capstan/effects/load_dependent_friction.h"
#include "capstan/effects/local_bend.h"
#include "capstan/effects/motor_cogging.h"
#include "capstan/effects/moving_bend.h"
#include "capstan/effects/presliding.h"
#include "capstan/effects/pretension_drift.h"
#include "capstan/effects/pulley_friction.h"
#include "capstan/effects/stribeck.h"
#include "capstan/effects/viscous_friction.h"

namespace capstan {

/// Everything of a bench's mechanics that the ideal model leaves out; as it stands, nothing.
struct BenchEffects {
    ViscousFriction viscous_friction;
    Stribeck stribeck;
    Presliding presliding;
    LoadDependentFriction load_dependent_friction;
    BendingStiffness bending_stiffness;
    LocalBend local_bend;
    MovingBend moving_bend;
    PulleyFriction motor_friction;
    PulleyFriction load_friction;
    MotorCogging motor_cogging;
    Inertia inertia;
    Backlash motor_backlash;
    Backlash load_backlash;
    ConduitCompliance conduit_compliance;
    NonlinearStiffness nonlinear_stiffness;
    Creep creep;
    PretensionDrift pretension_drift;
    EnvironmentCoupling environment_coupling;
};

}  // namespace capstan
