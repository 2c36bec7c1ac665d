//! Units as products of powers of the SI base units, read from their names.

/// Exponents of kg, m, s, A, K, mol, cd, rad, in the order of the standard's `BaseUnit`.
pub type Exponents = [i32; 8];

/// Names of the base units, in the order of [`Exponents`].
pub const BASE: [&str; 8] = ["kg", "m", "s", "A", "K", "mol", "cd", "rad"];

/// Exponents of a coherent SI unit such as `N.m`, `kg/m3` or `W/(m.K)`; `None` if it is not known.
pub fn exponents(unit: &str) -> Option<Exponents> {
    let (over, under) = match unit.split_once('/') {
        Some((over, under)) => (over, Some(under.trim_start_matches('(').trim_end_matches(')'))),
        None => (unit, None),
    };
    let mut total = product(over)?;
    if let Some(under) = under {
        for (sum, e) in total.iter_mut().zip(product(under)?) {
            *sum -= e;
        }
    }
    Some(total)
}

fn product(text: &str) -> Option<Exponents> {
    let mut total = [0; 8];
    for factor in text.split('.') {
        let split = factor.find(|c: char| c.is_ascii_digit() || c == '-').filter(|at| *at > 0);
        let (name, power) = factor.split_at(split.unwrap_or(factor.len()));
        let power: i32 = if power.is_empty() { 1 } else { power.parse().ok()? };
        for (sum, e) in total.iter_mut().zip(named(name)?) {
            *sum += power * e;
        }
    }
    Some(total)
}

#[rustfmt::skip]
fn named(name: &str) -> Option<Exponents> {
    Some(match name {
        "1"   => [0,  0,  0, 0, 0, 0, 0, 0],
        "kg"  => [1,  0,  0, 0, 0, 0, 0, 0],
        "m"   => [0,  1,  0, 0, 0, 0, 0, 0],
        "s"   => [0,  0,  1, 0, 0, 0, 0, 0],
        "A"   => [0,  0,  0, 1, 0, 0, 0, 0],
        "K"   => [0,  0,  0, 0, 1, 0, 0, 0],
        "mol" => [0,  0,  0, 0, 0, 1, 0, 0],
        "cd"  => [0,  0,  0, 0, 0, 0, 1, 0],
        "rad" => [0,  0,  0, 0, 0, 0, 0, 1],
        "Hz"  => [0,  0, -1, 0, 0, 0, 0, 0],
        "N"   => [1,  1, -2, 0, 0, 0, 0, 0],
        "Pa"  => [1, -1, -2, 0, 0, 0, 0, 0],
        "J"   => [1,  2, -2, 0, 0, 0, 0, 0],
        "W"   => [1,  2, -3, 0, 0, 0, 0, 0],
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_what_the_si_brochure_says() {
        assert_eq!(exponents("N.m"), Some([1, 2, -2, 0, 0, 0, 0, 0]));
        assert_eq!(exponents("kg/m3"), Some([1, -3, 0, 0, 0, 0, 0, 0]));
        assert_eq!(exponents("N.s/m"), Some([1, 0, -1, 0, 0, 0, 0, 0]));
        assert_eq!(exponents("W/(m.K)"), Some([1, 1, -3, 0, -1, 0, 0, 0]));
        assert_eq!(exponents("1/K"), Some([0, 0, 0, 0, -1, 0, 0, 0]));
        assert_eq!(exponents("furlong"), None);
    }
}
