//! Names as files, scene graphs and XML take them.

use std::collections::HashSet;

/// For each name an identifier of letters, digits and underscores that does not begin with a digit, no two alike.
pub(super) fn identifiers<'a>(names: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let mut taken = HashSet::new();
    let identifier = |name: &str| {
        let mut word: String =
            name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
        if word.starts_with(|c: char| c.is_ascii_digit()) || word.is_empty() {
            word.insert(0, '_');
        }
        let free = (2..).map(|n| format!("{word}_{n}"));
        // Where files are told apart by case only, some systems do not.
        let found =
            [word.clone()].into_iter().chain(free).find(|word| taken.insert(word.to_ascii_lowercase()));
        found.unwrap_or_else(|| unreachable!("numbers do not end"))
    };
    names.into_iter().map(identifier).collect()
}

/// Text for XML.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::identifiers;

    #[test]
    fn identifiers_are_words_and_differ() {
        let names = ["thread", "Thread", "a b", "a.b", "2nd", "", "../x", "thread_2"];
        let words = ["thread", "Thread_2", "a_b", "a_b_2", "_2nd", "_", "___x", "thread_2_2"];
        assert_eq!(identifiers(names), words);
    }
}
