//! Which serial numbers a plan takes.

use regex::Regex;

use super::check_digit::CheckDigit;

/// The most characters of a serial number.
pub(crate) const MOST_CHARACTERS: usize = 64;
/// What barcodes of the station's own begin with; no serial number does.
pub(crate) const RESERVED: &str = "HR:";

/// A serial number that a plan has taken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Serial {
    /// The whole.
    pub text: String,
    /// What the pattern's group `variant` matched; empty without one.
    pub variant: String,
}

/// A serial number that a plan does not take.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SerialError {
    /// There is no serial number in the scan.
    #[error("there is no serial number; scan the board's label")]
    Empty,
    /// The serial number is longer than any may be, as when two labels were read together.
    #[error(
        "a serial number of {characters} characters is longer than {MOST_CHARACTERS}; scan one label at a time"
    )]
    TooLong {
        /// How many it has.
        characters: usize,
    },
    /// The serial number has a character that no label has.
    #[error(
        "character {place} of the serial number is {character:?}, not printable ASCII; scan the label again"
    )]
    Character {
        /// The character.
        character: char,
        /// Its place, from 1.
        place: usize,
    },
    /// The text is one of the station's own barcodes, not a serial number.
    #[error("`{serial}` is a barcode of the station, not of a board; scan the board's label")]
    Reserved {
        /// What was scanned.
        serial: String,
    },
    /// The serial number begins or ends with a blank, which nobody sees.
    #[error(
        "`{serial}` begins or ends with a blank, which no table shows; scan the board's label again, or have an engineer look \
         at what the scanner or the label adds"
    )]
    Blank {
        /// What was scanned.
        serial: String,
    },
    /// The serial number is another product's, or was misread.
    #[error(
        "`{serial}` is no serial number of this product; scan the board's label again, \
         or take the plan of its product"
    )]
    Pattern {
        /// What was scanned.
        serial: String,
        /// The pattern that it does not match.
        pattern: String,
    },
    /// The serial number was misread: its check digit is wrong.
    #[error("the check digit of `{serial}` is wrong ({check}); scan the board's label again")]
    CheckDigit {
        /// What was scanned.
        serial: String,
        /// The kind of its check digits.
        check: CheckDigit,
    },
}

/// `[serial]` of a plan.
#[derive(Clone, Debug)]
pub struct SerialRule {
    pattern: Regex,
    source: String,
    check: CheckDigit,
}

impl SerialRule {
    /// The rule of `pattern`, a regular expression between `^` and `$`.
    ///
    /// # Errors
    /// What is wrong with the pattern, and what to do about it.
    pub(super) fn new(pattern: &str, check: CheckDigit) -> Result<Self, (String, &'static str)> {
        if !(pattern.starts_with('^') && pattern.ends_with('$')) {
            let what =
                format!("the pattern {pattern} is not anchored, and would take a part of a serial number");
            return Err((what, "begin it with ^ and end it with $"));
        }
        // An alternation in the pattern would leave each alternative with one anchor only.
        let regex = Regex::new(&format!(r"\A(?:{pattern})\z"))
            .map_err(|error| (one_line(&error), "write a regular expression as the crate regex reads it"))?;
        Ok(Self { pattern: regex, source: pattern.to_owned(), check })
    }

    /// Whether the pattern has a group `variant`.
    #[must_use]
    pub(crate) fn has_variants(&self) -> bool {
        self.pattern.capture_names().any(|name| name == Some("variant"))
    }

    /// The serial number that was scanned, unchanged, because whatever is cut off could have been a part of it.
    ///
    /// The check digits protect what the group `number` matches or, without that group, the whole.
    ///
    /// # Errors
    /// [`SerialError`] when it is none of this product's.
    pub fn read(&self, scanned: &str) -> Result<Serial, SerialError> {
        let characters = scanned.chars().count();
        if characters == 0 {
            return Err(SerialError::Empty);
        }
        if characters > MOST_CHARACTERS {
            return Err(SerialError::TooLong { characters });
        }
        let strange = scanned.chars().position(|character| !matches!(character, ' '..='~'));
        if let Some((place, character)) = strange.and_then(|place| Some((place, scanned.chars().nth(place)?)))
        {
            return Err(SerialError::Character { character, place: place + 1 });
        }
        let serial = scanned.to_owned();
        if serial.starts_with(RESERVED) {
            return Err(SerialError::Reserved { serial });
        }
        if serial.trim() != serial {
            return Err(SerialError::Blank { serial });
        }
        let Some(groups) = self.pattern.captures(scanned) else {
            return Err(SerialError::Pattern { serial, pattern: self.source.clone() });
        };
        let number = groups.name("number").map_or(scanned, |number| number.as_str());
        if !self.check.holds(number) {
            return Err(SerialError::CheckDigit { serial, check: self.check });
        }
        let variant = groups.name("variant").map_or_else(String::new, |variant| variant.as_str().to_owned());
        Ok(Serial { text: serial, variant })
    }
}

/// The last line of a message, which says what is wrong.
fn one_line(error: &regex::Error) -> String {
    let text = error.to_string();
    text.lines().last().unwrap_or_default().trim_start_matches("error: ").to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rule(pattern: &str, check: CheckDigit) -> SerialRule {
        SerialRule::new(pattern, check).unwrap()
    }

    #[test]
    fn a_serial_number_names_its_variant_and_is_kept_as_it_is() {
        let rule = rule("^CA(?<variant>[WN])(?<number>[0-9]{9}[0-9X])$", CheckDigit::Mod11);
        let serial = rule.read("CAW080442957X").unwrap();
        assert_eq!((serial.text.as_str(), serial.variant.as_str()), ("CAW080442957X", "W"));
    }

    /// Four units would look the same in every table.
    #[test]
    fn a_blank_at_either_end_is_refused_though_the_pattern_takes_it_and_one_within_is_not() {
        let rule = rule("^.*$", CheckDigit::None);
        for serial in [" A1", "A1 ", "   "] {
            let refused = rule.read(serial).unwrap_err();
            assert!(matches!(refused, SerialError::Blank { .. }) && refused.to_string().contains("blank"));
        }
        assert_eq!(rule.read("A 1").unwrap().text, "A 1");
    }

    /// The letters before it would count.
    #[test]
    fn a_check_digit_guards_the_number_alone() {
        for (pattern, check, serial) in [
            ("^CA-(?<number>[0-9A-Z]+)$", CheckDigit::Mod43, "CA-159AZH"),
            ("^CA(?<number>[0-9A-Z]+)$", CheckDigit::Mod97, "CA370400440532013000DE89"),
        ] {
            assert!(rule(pattern, check).read(serial).is_ok(), "{serial}");
            let whole = rule(&pattern.replace("?<number>", ""), check).read(serial);
            assert!(matches!(whole, Err(SerialError::CheckDigit { .. })), "{serial}: the control");
        }
    }

    #[test]
    fn misread_labels_are_refused_each_for_its_reason() {
        let rule = rule("^CA[WN][0-9]{9}[0-9X]$", CheckDigit::Mod11);
        let right = "CAW080442957X";
        rule.read(right).unwrap();
        let pattern = |serial: &str| SerialError::Pattern {
            serial: serial.to_owned(),
            pattern: "^CA[WN][0-9]{9}[0-9X]$".to_owned(),
        };
        let of_check =
            |serial: &str| SerialError::CheckDigit { serial: serial.to_owned(), check: CheckDigit::Mod11 };
        // A digit is missing, doubled; lower case; a blank within; another product.
        for scanned in ["CAW08044295X", "CAW0880442957X", "caw080442957X", "CAW 080442957X", "CB1"] {
            assert_eq!(rule.read(scanned), Err(pattern(scanned)));
        }
        // A digit is changed; neighbours are swapped; the check digit is another.
        for scanned in ["CAW080442947X", "CAW084042957X", "CAW0804429573"] {
            assert_eq!(rule.read(scanned), Err(of_check(scanned)));
        }
        assert_eq!(rule.read(""), Err(SerialError::Empty));
        assert_eq!(rule.read(&right.repeat(5)), Err(SerialError::TooLong { characters: 65 }));
        let control = SerialError::Character { character: '\t', place: 14 };
        assert_eq!(rule.read("CAW080442957X\t"), Err(control));
        assert_eq!(rule.read(&right.repeat(2)), Err(pattern(&right.repeat(2))), "two labels run together");
    }

    #[test]
    fn no_pattern_takes_a_barcode_of_the_station() {
        let rule = rule("^[A-Z:]+$", CheckDigit::None);
        let serial = "HR:START".to_owned();
        assert_eq!(rule.read(&serial), Err(SerialError::Reserved { serial }));
    }

    #[test]
    fn an_alternative_does_not_lift_an_anchor() {
        let rule = rule("^A|B$", CheckDigit::None);
        assert!(rule.read("A").is_ok() && rule.read("B").is_ok());
        assert!(rule.read("AX").is_err() && rule.read("XB").is_err());
    }

    #[test]
    fn a_pattern_that_is_none_is_told_what_to_be() {
        let (what, remedy) = SerialRule::new("CA[0-9]+", CheckDigit::None).unwrap_err();
        assert!(what.contains("not anchored") && remedy.contains("begin it with ^"), "{what}");
        let (what, _) = SerialRule::new("^CA[0-9$", CheckDigit::None).unwrap_err();
        assert!(what.contains("unclosed character class"), "{what}");
    }
}
