//! What may be added to constant friction.

/// A law that may be added to constant friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// Constant friction: nothing is missing.
    Constant,
    /// Friction that follows the logarithm of the speed as soon as the rig has stretched: the base
    /// model has it, so it is recalibration and not an effect.
    Speed,
    /// Friction that builds up over a length after a change of direction: something gives way.
    RigCompliance,
    /// Friction that remembers the slip since the last change: rate and state.
    FrictionAgeing,
    /// Friction that follows the friction power over a time.
    ThermalFriction,
    /// A force that does not grow with the load.
    Adhesion,
    /// Friction that changes along the way: a tilted or worn partner.
    Misalignment,
    /// Friction that drifts with all the slip there was: wear.
    Drift,
}

impl Law {
    /// All.
    pub const ALL: [Self; 8] = [
        Self::Constant,
        Self::Speed,
        Self::RigCompliance,
        Self::FrictionAgeing,
        Self::ThermalFriction,
        Self::Adhesion,
        Self::Misalignment,
        Self::Drift,
    ];

    /// Name in the results; effects of the list have their own.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Constant => "none",
            Self::Speed => "recalibration (speed)",
            Self::RigCompliance => "rig_compliance",
            Self::FrictionAgeing => "friction_ageing",
            Self::ThermalFriction => "thermal_friction",
            Self::Adhesion => "adhesion",
            Self::Misalignment => "misalignment",
            Self::Drift => "wear (drift with slip)",
        }
    }
}
