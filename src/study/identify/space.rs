//! The unknowns: parameters of the model by their dotted names, scaled to the unit interval.

use crate::error::Problem;
use crate::params::{table, FrictionForm, Params, Value};

/// One unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unknown {
    /// Dotted name.
    pub name: &'static str,
    /// Lower bound, SI.
    pub low: f64,
    /// Upper bound, SI.
    pub high: f64,
    /// Is it searched on a logarithmic scale?
    pub logarithmic: bool,
}

impl Unknown {
    /// SI value at `x` in \[0, 1\].
    pub fn value(&self, x: f64) -> f64 {
        let x = x.clamp(0.0, 1.0);
        if self.logarithmic {
            self.low * (self.high / self.low).powf(x)
        } else {
            self.low + x * (self.high - self.low)
        }
    }

    /// Where in \[0, 1\] an SI value lies.
    pub fn place(&self, value: f64) -> f64 {
        let x = if self.logarithmic {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        };
        x.clamp(0.0, 1.0)
    }
}

const fn linear(name: &'static str, low: f64, high: f64) -> Unknown {
    Unknown { name, low, high, logarithmic: false }
}

const fn log(name: &'static str, low: f64, high: f64) -> Unknown {
    Unknown { name, low, high, logarithmic: true }
}

/// Unknowns whatever the friction law.
const COMMON: [Unknown; 10] = [
    linear("friction.mu_inf", 0.02, 1.2),
    log("friction.mu_drop", 0.1, 6.0),
    log("friction.decay_speed", 0.05, 100.0),
    log("friction.smoothing_speed", 3e-4, 3e-2),
    linear("friction.pressure_exponent", -0.4, 0.2),
    log("rubber.stiffness_damping", 5e-6, 2e-4),
    log("contact.reference_pressure", 3e3, 1e6),
    log("contact.depth", 2e-6, 2e-4),
    log("carriage.mass", 1e-2, 1e3),
    log("carriage.damping", 1.0, 3e3),
];

/// The unknowns that go with a friction law.
pub fn unknowns(form: FrictionForm) -> Vec<Unknown> {
    let mut out = COMMON.to_vec();
    match form {
        FrictionForm::Exponential => out.push(linear("friction.decay_exponent", 0.25, 1.5)),
        FrictionForm::Rational => out.push(linear("friction.rational_exponent", 0.25, 2.5)),
        FrictionForm::LogBell => out.push(linear("friction.bell_steepness", 0.1, 1.5)),
        FrictionForm::TwoExponentials => out.extend([
            log("friction.decay_exponent", 0.2, 4.0),
            linear("friction.slow_share", 0.0, 0.95),
            log("friction.slow_speed", 0.1, 100.0),
            log("friction.slow_exponent", 0.2, 4.0),
        ]),
        FrictionForm::Table => {}
    }
    out
}

/// Sets unknowns at `x` (unit intervals) on top of `params`.
pub fn apply(unknowns: &[Unknown], x: &[f64], params: &mut Params) {
    for (unknown, x) in unknowns.iter().zip(x) {
        set(params, unknown.name, unknown.value(*x));
    }
}

/// Places of the unknowns in `params`.
pub fn places(unknowns: &[Unknown], params: &Params) -> Vec<f64> {
    unknowns.iter().map(|u| u.place(get(params, u.name))).collect()
}

/// Value of a real parameter; 0 for a name that is none.
pub fn get(params: &Params, name: &str) -> f64 {
    match table::find(name).map(|spec| (spec.get)(params)) {
        Some(Value::Real(x)) => x,
        _ => 0.0,
    }
}

/// Sets a real parameter; a name that is none changes nothing.
pub fn set(params: &mut Params, name: &str, value: f64) {
    if let Some(spec) = table::find(name) {
        (spec.set)(params, &Value::Real(value));
    }
}

/// The unknowns of the given names, in that order.
///
/// # Errors
/// All names that are not unknowns of this law.
pub fn select(all: &[Unknown], names: &[String]) -> Result<Vec<Unknown>, Vec<Problem>> {
    let allowed = all.iter().map(|u| u.name).collect::<Vec<_>>().join(", ");
    let (found, missing): (Vec<_>, Vec<_>) = names
        .iter()
        .map(|name| all.iter().find(|u| u.name == name).copied().ok_or(name))
        .partition(Result::is_ok);
    if missing.is_empty() {
        return Ok(found.into_iter().flatten().collect());
    }
    let problem = |name: &String| {
        Problem::new("unknown to identify", name.as_str(), &*allowed, "correct or drop the name")
    };
    Err(missing.into_iter().filter_map(Result::err).map(problem).collect())
}
