//! Units as people write them, to SI; which unit belongs to which dimension is the units library's.

use uom::si::f64::{Force, Length, Time, Velocity};
use uom::si::{force::newton, length::meter, time::second, velocity::meter_per_second};

/// What a number measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// \[N\].
    Force,
    /// \[m/s\].
    Speed,
    /// \[m\].
    Length,
    /// \[s\].
    Time,
}

impl Dimension {
    /// Of the channels, in the order of [`super::super::campaign::CHANNELS`].
    pub const OF_CHANNELS: [Self; super::super::campaign::CHANNEL_COUNT] =
        [Self::Force, Self::Force, Self::Speed, Self::Length, Self::Length];

    /// What would be accepted, for messages.
    pub const fn allowed(self) -> &'static str {
        match self {
            Self::Force => "a unit of force such as N, kN or lbf, or what one count is worth, such as \"25 N\"",
            Self::Speed => "a unit of speed such as mm/s, m/s or km/h, or what one count is worth, such as \"25 mm/s\"",
            Self::Length => "a unit of length such as mm or µm, or what one count is worth, such as \"0.1 mm\"",
            Self::Time => "a unit of time such as s, ms or µs",
        }
    }
}

/// The SI value of a unit (`kN`: 1000) or of a number with its unit (`-25 mm/s`: -0.025); `None` if
/// it is no finite quantity of this dimension, or zero. A bare number has no unit and is none.
pub fn si(dimension: Dimension, text: &str) -> Option<f64> {
    quantity(dimension, text).filter(|value| *value != 0.0)
}

/// The same for a quantity that may be zero, such as an instant.
pub fn quantity(dimension: Dimension, text: &str) -> Option<f64> {
    let text = spelled(text.trim());
    let text = if number_with_unit(&text) { text } else { format!("1 {text}") };
    let value = match dimension {
        Dimension::Force => text.parse::<Force>().ok()?.get::<newton>(),
        Dimension::Speed => text.parse::<Velocity>().ok()?.get::<meter_per_second>(),
        Dimension::Length => text.parse::<Length>().ok()?.get::<meter>(),
        Dimension::Time => text.parse::<Time>().ok()?.get::<second>(),
    };
    Some(value).filter(|v| v.is_finite())
}

/// Does the text begin with a number, and does something follow it?
fn number_with_unit(text: &str) -> bool {
    text.split_once(char::is_whitespace).is_some_and(|(first, _)| first.parse::<f64>().is_ok())
}

/// The library writes micro as U+00B5; keyboards give u, and other files the Greek letter.
fn spelled(text: &str) -> String {
    let text = text.replace('\u{3bc}', "\u{b5}");
    let (number, unit) = match text.split_once(char::is_whitespace) {
        Some((number, unit)) if number.parse::<f64>().is_ok() => (Some(number), unit.trim()),
        _ => (None, text.as_str()),
    };
    let micro = ["um", "us", "uN"]
        .iter()
        .any(|u| unit.strip_prefix(u).is_some_and(|rest| rest.is_empty() || rest.starts_with('/')));
    let unit = if micro { format!("\u{b5}{}", &unit[1..]) } else { unit.to_string() };
    number.map_or(unit.clone(), |n| format!("{n} {unit}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_worth_what_their_definitions_say() {
        // SI brochure for prefixes; lbf = 0.45359237 kg x 9.80665 m/s2, inch = 25.4 mm by definition.
        for (dimension, text, value) in [
            (Dimension::Force, "kN", 1e3),
            (Dimension::Force, "newton", 1.0),
            (Dimension::Force, "lbf", 4.448_222), // the crate rounds 0.45359237 kg x 9.80665 m/s2
            (Dimension::Speed, "mm/s", 1e-3),
            (Dimension::Speed, "km/h", 1.0 / 3.6),
            (Dimension::Speed, "-25 mm/s", -0.025),
            (Dimension::Length, "um", 1e-6),
            (Dimension::Length, "\u{3bc}m", 1e-6),
            (Dimension::Length, "in", 0.0254),
            (Dimension::Length, "0.1 mm", 1e-4),
            (Dimension::Time, "us", 1e-6),
            (Dimension::Time, "12.5 ms", 0.0125),
        ] {
            let got = si(dimension, text).unwrap();
            assert!((got / value - 1.0).abs() < 1e-12, "{text}: {got} is not {value}");
        }
    }

    #[test]
    fn what_is_no_unit_of_the_dimension_is_none() {
        for (dimension, text) in [
            (Dimension::Force, "V"),
            (Dimension::Force, "mm"),
            (Dimension::Force, "3"),
            (Dimension::Force, ""),
            (Dimension::Speed, "mm"),
            (Dimension::Length, "0 mm"),
            (Dimension::Time, "nan s"),
        ] {
            assert_eq!(si(dimension, text), None, "{text}");
        }
    }
}
