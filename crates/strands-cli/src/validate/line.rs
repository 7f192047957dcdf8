//! One comparison, as it is printed.

/// A quantity of a solved problem beside its reference value.
#[derive(Clone, Debug)]
pub struct Line {
    /// The case's name.
    pub case: String,
    /// What the case is, in a line.
    pub title: String,
    /// Who published it, and how the figures were found.
    pub source: String,
    /// Which row of the case.
    pub label: String,
    /// Which quantity of it.
    pub quantity: String,
    /// Its reference value.
    pub expected: String,
    /// What was found.
    pub got: String,
    /// How far it is from the reference value, over the size that the case measures it by. Infinite where nothing was found.
    pub error: f64,
    /// The largest error that is accepted.
    pub tolerance: f64,
}

impl Line {
    /// A line of a case before anything is known.
    pub fn blank(case: &str, title: &str, source: &str, tolerance: f64) -> Self {
        let [label, quantity, expected, got] = [const { String::new() }; 4];
        let [case, title, source] = [case, title, source].map(str::to_owned);
        Self { case, title, source, label, quantity, expected, got, error: f64::INFINITY, tolerance }
    }

    /// Whether the error is within the tolerance. One that is not a number is not.
    pub fn ok(&self) -> bool {
        self.error <= self.tolerance
    }

    /// The error over the tolerance, by which lines of different tolerances compare.
    pub fn badness(&self) -> f64 {
        if self.error == 0.0 { 0.0 } else { self.error / self.tolerance }
    }

    /// The line that is furthest out of its tolerance, or nearest to it.
    pub fn worst(lines: &[Self]) -> Option<&Self> {
        lines.iter().max_by(|a, b| a.badness().total_cmp(&b.badness()))
    }

    /// The line as a JSON object.
    pub fn json(&self) -> serde_json::Value {
        let Self { case, title, source, label, quantity, expected, got, error, tolerance } = self;
        serde_json::json!({
            "case": case, "title": title, "source": source, "row": label, "quantity": quantity,
            "expected": expected, "got": got, "error": error, "tolerance": tolerance, "ok": self.ok(),
        })
    }

    /// The source in a few words: who, and when. The first of several.
    pub fn short_source(&self) -> String {
        let first = self.source.split(';').next().unwrap_or_default();
        let who = first.split([',', ':']).next().unwrap_or_default().trim();
        let is_year = |word: &&str| word.len() == 4 && word.bytes().all(|c| c.is_ascii_digit());
        let year = first.split(|c: char| !c.is_ascii_alphanumeric()).rfind(is_year);
        let who = match year {
            Some(year) if !who.contains(year) => format!("{who} {year}"),
            _ => who.to_owned(),
        };
        shortened(&who, 23)
    }
}

/// A text cut to so many characters, with a mark where something is missing.
pub fn shortened(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    let kept: String = text.chars().take(most - 1).collect();
    format!("{}…", kept.trim_end())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(source: &str, error: f64, tolerance: f64) -> Line {
        let text = || String::new();
        Line {
            case: text(),
            title: text(),
            source: source.into(),
            label: text(),
            quantity: text(),
            expected: text(),
            got: text(),
            error,
            tolerance,
        }
    }

    #[test]
    fn a_source_is_shortened_to_who_and_when() {
        for (source, short) in [
            (
                "Bisshopp & Drucker, Quart. Appl. Math. 3:272–275, 1945: elliptic integrals",
                "Bisshopp & Drucker 1945",
            ),
            ("Euler; Simo & Vu-Quoc, CMAME 58:79–116, 1986, pure bending", "Euler"),
            ("closed form of the rectangular elastica; Argyris", "closed form of the rec…"),
            ("", ""),
        ] {
            assert_eq!(with(source, 0.0, 0.0).short_source(), short);
        }
    }

    #[test]
    fn what_has_no_number_fails_and_is_the_worst() {
        let lines = [with("a", 2e-7, 1e-6), with("b", f64::NAN, 1e-6), with("c", 1e-3, 1e-6)];
        assert!(lines[0].ok() && !lines[1].ok() && !lines[2].ok());
        assert_eq!(Line::worst(&lines).map(|line| line.source.as_str()), Some("b"));
        assert!(with("exact", 0.0, 0.0).ok());
    }
}
