//! Numbers as engineers read them.

/// A value with a prefix that leaves one to three digits before the point, to four digits: `12.35 mN`.
pub fn engineering(value: f64, unit: &str) -> String {
    const PREFIXES: [(i32, &str); 9] =
        [(-12, "p"), (-9, "n"), (-6, "µ"), (-3, "m"), (0, ""), (3, "k"), (6, "M"), (9, "G"), (12, "T")];
    if value == 0.0 {
        return format!("0 {unit}").trim_end().to_owned();
    }
    if !value.is_finite() {
        return format!("{value} {unit}");
    }
    // Rounding first: 999.96 is a thousand.
    let exponent = exponent_after_rounding(value, 4);
    let thousand = exponent.div_euclid(3) * 3;
    let (power, prefix) = match PREFIXES.iter().find(|(power, _)| *power == thousand) {
        Some(&found) => found,
        None => return format!("{} {unit}", digits(value, 4)),
    };
    format!("{} {prefix}{unit}", digits(value / 10_f64.powi(power), 4))
}

/// A value to so many significant digits, without an exponent where it is neither large nor small.
pub fn digits(value: f64, significant: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let exponent = exponent_after_rounding(value, significant);
    let last = significant as i32 - 1;
    if (-4..=6).contains(&exponent) {
        let decimals = usize::try_from(last - exponent).unwrap_or(0);
        format!("{value:.decimals$}")
    } else {
        format!("{value:.*e}", significant - 1)
    }
}

fn exponent_after_rounding(value: f64, significant: usize) -> i32 {
    let written = format!("{value:.*e}", significant - 1);
    written.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn engineering_numbers_have_four_digits_and_a_prefix() {
        for (value, text) in [
            (0.012345, "12.35 mN"),
            (-3.2e-7, "-320.0 nN"),
            (0.999_96, "1.000 N"),
            (1234.0, "1.234 kN"),
            (0.0, "0 N"),
            (2e-15, "2.000e-15 N"),
        ] {
            assert_eq!(engineering(value, "N"), text);
        }
        assert_eq!(digits(1234.56, 4), "1235");
        assert_eq!(digits(0.001234, 2), "0.0012");
    }
}
