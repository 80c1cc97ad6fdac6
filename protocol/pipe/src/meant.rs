//! Which word of a list was probably meant by a word that is not in it.

/// How similar a word must be to one of a list, 0 to 1, to be taken for a misspelling of it.
const LIKENESS: f64 = 0.8;

/// The word of `known` that `given` was most likely meant to be, as a phrase to put after `given`, such as
/// ` (did you mean late?)`. Empty if no word is similar. `known` is a list with commas, up to a semicolon or its end.
#[must_use]
pub fn meant(given: &str, known: &str) -> String {
    let given = given.to_lowercase();
    let words = known.split(';').next().unwrap_or_default().split(", ");
    let likeness = words.map(|word| (strsim::jaro_winkler(&given, word), word));
    let nearest = likeness.max_by(|one, other| one.0.total_cmp(&other.0));
    nearest
        .filter(|(likeness, _)| *likeness >= LIKENESS)
        .map_or_else(String::new, |(_, word)| format!(" (did you mean {word}?)"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_is_told_from_what_is_like_nothing() {
        let known = "stuck-data, stuck-address, late; a fault's parameters need fault=NAME";
        assert_eq!(meant("stuk-data", known), " (did you mean stuck-data?)");
        assert_eq!(meant("Late", known), " (did you mean late?)");
        assert_eq!(meant("moon", known), "");
    }
}
