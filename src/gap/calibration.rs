//! Numbers that turn levels into probabilities.
//!
//! Set by hand from the levels of the campaigns of `open/`, never from the sealed ones; 15 campaigns are
//! too few to fit them. Their common scale is fitted on own campaigns. See the book, `gap.md`.

/// Nats per unit of ln(G²) between hypotheses: the effective number of independent comparisons,
/// far below the number of features since errors of one model are correlated everywhere.
pub const SHARPNESS: f64 = 9.0;
/// Logarithms of odds are multiplied by this in the end: the least log loss on 32 campaigns of the own simulator
/// (`make-suite --count 32 --seed 41`), whose answers were less sure than they were right (0.310 to 0.307, expected
/// calibration error 0.081 to 0.032).
pub const SURENESS: f64 = 1.15;
/// Added to G² before the logarithm: below the floor nothing can be told.
pub const BLUR: f64 = 0.25;
/// Logarithm of the odds of "no gap" before the data.
pub const PRIOR_NONE: f64 = 2.5;
/// Logarithm of the odds of "unknown" before the data.
pub const PRIOR_UNKNOWN: f64 = -1.0;
/// Logarithm of the odds of two effects at once before the data.
pub const PRIOR_PAIR: f64 = -4.0;
/// Nats per logarithm of what a pair leaves on runs that no fit has seen, over what its first effect alone leaves
/// there. In `open/` and three own pairs a true second effect takes that by a factor of 1.4 to 2.4, a false one by 1.1
/// at most.
pub const SECOND_HELD_OUT: f64 = 4.0;
/// Nats per logarithm of what no effect leaves on runs that no fit has seen, over what the effect leaves there, up to
/// which it is believed what it takes off the fitted runs. In two own suites true effects leave 0.7 of it at most, one
/// that was called where there is none left 0.98.
pub const FIRST_HELD_OUT: f64 = 9.0;
/// Logarithm of what two single effects leave on runs that no fit has seen, up to which these do not tell them apart.
pub const ALIKE: f64 = 0.25;
/// Share of the gap that both then close at least.
pub const ALIKE_CLOSED: f64 = 0.5;
/// Nats that the fitted runs then count at most between the two.
pub const ALIKE_NATS: f64 = 0.5;
/// Share of the gap below which what is left counts no less.
pub const LEAST_LEFT: f64 = 0.05;
/// An unknown cause is taken to leave this share of ln(G²) that the recalibrated model leaves.
pub const UNKNOWN_LEAVES: f64 = 0.7;
/// G² up to which a recalibrated model has no gap worth a name.
pub const NO_GAP: f64 = 0.9;
/// Probability from which an effect is named.
pub const NAME_FROM: f64 = 0.7;
/// Probability that a class of effects must hold together.
pub const CLASS_FROM: f64 = 0.9;
/// Most effects that a class may hold.
pub const CLASS_SIZE: usize = 3;
/// Nats against a cause for every rule of the data that it contradicts.
pub const CONTRADICTION: f64 = 9.0;
/// Nats against "unknown" where a rule is broken that effects of the list break.
pub const KNOWN_BREAKER: f64 = 4.0;
/// Level up to which the recalibrated model alone is good; both campaigns without an effect in
/// `open/` stay below 0.5.
pub const GOOD: f64 = 1.2;
/// Nats against "none" per unit of ln(level) above [`GOOD`].
pub const INADEQUATE: f64 = 5.0;
/// Share of its level that a road texture is held to: its profile is not known, a tilt's and a worn
/// edge's are.
pub const TEXTURE_ALLOWANCE: f64 = 0.75;
