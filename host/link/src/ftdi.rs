//! What FTDI's chips have in common, whether the system's driver uses them or this program: a vendor id, and baud generators that
//! divide a clock in steps of an eighth. The driver silently takes the nearest rate, however far off it is.

/// FTDI's vendor id.
pub(crate) const VENDOR: u16 = 0x0403;

/// The product ids of the chips that this program opens over USB, and that scripts/70-halfrow.rules names.
pub(crate) const PRODUCTS: [u16; 5] = [0x6001, 0x6010, 0x6011, 0x6014, 0x6015];

/// How far a rate may be from the one that was asked for. A receiver samples the last of ten bits half a bit from its edge, so 5
/// % would miss it. Each side may use up a part of that.
pub(crate) const TOLERANCE: f64 = 0.02;

/// The two families of chips, by the clock of their baud generators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Speed {
    /// FT2232H, FT4232H, FT232H and their successors: 12 MHz.
    High,
    /// FT232R and all older ones: 3 MHz.
    Full,
}

impl Speed {
    /// The family of a chip of FTDI's, by its device version.
    pub(crate) fn of(version: u16) -> Self {
        match version {
            0x0700 | 0x0800 | 0x0900 | 0x2800.. => Self::High,
            _ => Self::Full,
        }
    }

    /// The fastest serial rate, in baud.
    pub(crate) fn fastest(self) -> u32 {
        match self {
            Self::High => 12_000_000,
            Self::Full => 3_000_000,
        }
    }

    /// The divisor for `baud` as the request encodes it: eighths in bits 14 to 16, bit 17 for the 12 MHz clock.
    ///
    /// Below the fastest rate there are two special ones without eighths, 2/3 and 1/2 of it. Between the fastest rate and half of
    /// it a high-speed chip's output jitters and collapses to 2/3, so those rates are refused, including 2/3.
    ///
    /// # Errors
    /// The nearest rates that the chip makes, the lower first, when none is close enough to `baud`.
    pub(crate) fn divisor(self, baud: u32) -> Result<u32, Vec<u32>> {
        const EIGHTHS: [u32; 8] = [0, 3, 2, 4, 1, 5, 6, 7];
        let fastest = f64::from(self.fastest());
        let wanted = f64::from(baud).max(1.0);
        // The largest divisor is 2^14 - 1 and seven eighths.
        let near = (8.0 * fastest / wanted).clamp(8.0, 131_071.0);
        let mut rates: Vec<(f64, u32)> = [near.floor(), near.ceil(), 8.0, 12.0, 16.0]
            .into_iter()
            .filter(|&eighths| eighths == 8.0 || eighths >= 16.0 || !(self == Self::High) && eighths == 12.0)
            .map(|eighths| (8.0 * fastest / eighths, eighths as u32))
            .collect();
        rates.sort_by(|one, other| (one.0 - wanted).abs().total_cmp(&(other.0 - wanted).abs()));
        rates.dedup();
        let (rate, eighths) = rates[0];
        if (rate - wanted).abs() > TOLERANCE * wanted {
            let mut nearest: Vec<u32> = rates.iter().take(2).map(|(rate, _)| rate.round() as u32).collect();
            nearest.sort_unstable();
            return Err(nearest);
        }
        let divisor = match eighths {
            8 => 0,
            12 => 1,
            _ => eighths >> 3 | EIGHTHS[(eighths & 7) as usize] << 14,
        };
        Ok(if self == Self::High { divisor | 0x20000 } else { divisor })
    }
}

/// The rates as an error lists them.
pub(crate) fn list(rates: &[u32]) -> String {
    let rates: Vec<String> = rates.iter().map(ToString::to_string).collect();
    rates.join(" and ")
}

#[cfg(test)]
mod tests {
    use super::*;

    const RULES: &str = include_str!("../../../scripts/70-halfrow.rules");

    /// Without this, the rules are recommended to users whom they do not help.
    #[test]
    fn the_rules_let_users_open_every_chip_that_is_opened() {
        let listed = RULES.split("ATTRS{idProduct}==\"").nth(1).unwrap().split('"').next().unwrap();
        let mut listed: Vec<_> = listed.split('|').map(|id| u16::from_str_radix(id, 16).unwrap()).collect();
        listed.sort_unstable();
        assert_eq!(listed, PRODUCTS);
    }

    /// The same chips are in many an adapter that is no board's, whose users are in the group that the system gives its port.
    #[test]
    fn the_rules_leave_serial_ports_to_the_group_that_they_have() {
        let rules: Vec<_> = RULES.lines().filter(|line| !line.starts_with('#')).collect();
        let of_ports: Vec<_> = rules.iter().filter(|rule| rule.contains("SUBSYSTEM==\"tty\"")).collect();
        assert!(!of_ports.is_empty(), "no rule is for ports");
        for rule in rules.iter().filter(|rule| !rule.contains("SUBSYSTEM==\"usb\"")) {
            for taken in ["GROUP=", "OWNER=", "MODE="] {
                assert!(!rule.contains(taken), "{rule}");
            }
        }
        assert!(of_ports.iter().all(|rule| rule.contains("TAG+=\"uaccess\"")), "{of_ports:?}");
    }

    #[test]
    fn the_family_is_told_by_the_version() {
        assert_eq!(Speed::of(0x0700), Speed::High);
        assert_eq!(Speed::of(0x0600), Speed::Full);
    }

    #[test]
    fn the_divisors_of_a_high_speed_chip_are_those_of_its_data_sheet() {
        for (baud, divisor) in [
            (12_000_000, 0x20000),
            (6_000_000, 0x20002),
            (3_000_000, 0x20004),
            (2_000_000, 0x20006),
            (1_000_000, 0x2000c),
            (921_600, 0x2000d),
            (115_200, 0x2c068),
        ] {
            assert_eq!(Speed::High.divisor(baud), Ok(divisor), "{baud}");
        }
    }

    #[test]
    fn the_divisors_of_a_full_speed_chip_are_those_of_its_data_sheet() {
        // AN232B-05: 3 M, 2 M, 921,600 (3.25), 115,200 (26), 9600 (312.5).
        for (baud, divisor) in
            [(3_000_000, 0), (2_000_000, 1), (921_600, 0x8003), (115_200, 0x1a), (9600, 0x4138)]
        {
            assert_eq!(Speed::Full.divisor(baud), Ok(divisor), "{baud}");
        }
    }

    #[test]
    fn a_rate_that_a_chip_cannot_make_is_refused_with_those_beside_it() {
        for baud in [7_000_000, 8_000_000, 9_000_000, 10_000_000, 11_000_000] {
            assert_eq!(Speed::High.divisor(baud), Err(vec![6_000_000, 12_000_000]), "{baud}");
        }
        assert_eq!(Speed::High.divisor(20_000_000), Err(vec![6_000_000, 12_000_000]));
        // 96 MHz / 5.82 MHz is 16.5, so both neighbours are 2.9 % away.
        assert_eq!(Speed::High.divisor(5_820_000), Err(vec![5_647_059, 6_000_000]));
        assert_eq!(Speed::Full.divisor(12_000_000), Err(vec![2_000_000, 3_000_000]));
        assert!(Speed::High.divisor(0).is_err());
    }
}
