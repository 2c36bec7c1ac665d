//! What a fit may vary in an effect: parameters with their prior knowledge, per functional form.

use crate::params::{table, Params, Value};

/// Module of the model to which an effect belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Module {
    /// Elasticity, damping and inertia of the rubber.
    Dynamic,
    /// Friction law.
    Friction,
    /// Normal contact.
    Contact,
    /// Shape of the worn block.
    Wear,
    /// Carriage and mounting.
    Rig,
    /// Measuring chain.
    Sensor,
}

impl Module {
    /// Name as it appears in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Dynamic => "dynamic",
            Self::Friction => "friction",
            Self::Contact => "contact",
            Self::Wear => "wear",
            Self::Rig => "rig",
            Self::Sensor => "sensor",
        }
    }
}

/// Width of a prior.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spread {
    /// Log-normal around the centre; standard deviation of the logarithm \[-\].
    Log(f64),
    /// Normal around the centre; standard deviation in the parameter's unit. For signed parameters.
    Absolute(f64),
}

impl Spread {
    /// Is it that of a parameter with a sign?
    pub const fn is_signed(&self) -> bool {
        matches!(self, Self::Absolute(_))
    }
}

/// One parameter of a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitParam {
    /// Dotted name in the parameter table.
    pub name: &'static str,
    /// Centre of the prior \[SI\]; where `spread` is logarithmic, its median.
    pub centre: f64,
    /// Width of the prior.
    pub spread: Spread,
}

/// One functional form of an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitForm {
    /// Item of the enumeration `effect.<name>.form`; empty where the effect has a single form.
    pub name: &'static str,
    /// Its free parameters; the first is the severity, which at 0 switches the effect off.
    pub params: &'static [FitParam],
}

/// What a fit needs to know of an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitSpec {
    /// Name of the effect.
    pub effect: &'static str,
    /// Module of the model.
    pub module: Module,
    /// Its functional forms.
    pub forms: &'static [FitForm],
}

/// Value of the severity, the first parameter of every form, at which an effect is off.
pub const OFF: f64 = 0.0;

impl FitSpec {
    /// Enables the effect in `params` with its form number `form` and `values` of that form's
    /// parameters; `false` if there is no such form or a value is missing.
    pub fn apply(&self, form: usize, values: &[f64], params: &mut Params) -> bool {
        let Some(form) = self.forms.get(form) else { return false };
        let prefix = format!("effect.{}", self.effect);
        let set = |name: &str, value: Value, params: &mut Params| {
            table::find(name).is_some_and(|spec| (spec.set)(params, &value))
        };
        let chosen = form.name.is_empty()
            || item(&format!("{prefix}.form"), form.name)
                .is_some_and(|i| set(&format!("{prefix}.form"), Value::Integer(i), params));
        chosen
            && form.params.len() == values.len()
            && set(&format!("{prefix}.enabled"), Value::Boolean(true), params)
            && form.params.iter().zip(values).all(|(p, v)| set(p.name, Value::Real(*v), params))
    }
}

/// Number of an item of the enumeration parameter `name`.
fn item(name: &str, item: &str) -> Option<i32> {
    match table::find(name)?.kind {
        table::Kind::Enumeration { items, .. } => {
            items.iter().position(|i| i.name == item).map(|at| at as i32 + 1)
        }
        _ => None,
    }
}

/// A parameter with a log-normal prior.
pub const fn log(name: &'static str, median: f64, log_std: f64) -> FitParam {
    FitParam { name, centre: median, spread: Spread::Log(log_std) }
}

/// A signed parameter with a normal prior.
pub const fn signed(name: &'static str, centre: f64, std: f64) -> FitParam {
    FitParam { name, centre, spread: Spread::Absolute(std) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{fit_specs, Effects, NAMES};
    use crate::params::{check, Kind};

    #[test]
    fn every_effect_can_be_set_to_its_prior_in_every_form() {
        assert_eq!(fit_specs().len(), NAMES.len());
        for (spec, name) in fit_specs().iter().zip(NAMES) {
            assert_eq!(spec.effect, *name);
            for (k, form) in spec.forms.iter().enumerate() {
                let values: Vec<f64> = form.params.iter().map(|p| p.centre).collect();
                let mut params = Params::default();
                assert!(spec.apply(k, &values, &mut params), "{name} form {}", form.name);
                assert!(params.effect != Effects::default(), "{name} is not enabled");
                assert_eq!(check::problems(&params), vec![]);
            }
        }
    }

    #[test]
    fn severity_zero_is_within_the_range_of_every_first_parameter() {
        for spec in fit_specs() {
            for form in spec.forms {
                let first = table::find(form.params[0].name).unwrap();
                let Kind::Real { min, max, .. } = first.kind else { panic!("{}", first.name) };
                assert!((min..=max).contains(&OFF), "{}", first.name);
            }
        }
    }
}
