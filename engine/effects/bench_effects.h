// The one list of effects. The rig's kernel includes this file again for each instruction set, so that it
// sees the law of every effect; the list itself is declared once.
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

#ifndef CAPSTAN_EFFECTS_BENCH_EFFECTS_H
#define CAPSTAN_EFFECTS_BENCH_EFFECTS_H
#include "capstan/effects/effect_set.h"

namespace capstan {

/// All mechanics of a bench that the ideal model leaves out; by default every effect is absent. In the order
/// of the catalogue.
using BenchEffects =
    EffectSet<ViscousFriction, Stribeck, Presliding, LoadDependentFriction, BendingStiffness, LocalBend,
              MovingBend, PulleyFriction, MotorCogging, Inertia, Backlash, ConduitCompliance,
              NonlinearStiffness, Creep, EnvironmentCoupling, PretensionDrift>;

}  // namespace capstan
#endif
