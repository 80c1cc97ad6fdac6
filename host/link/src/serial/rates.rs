//! The rates that FTDI's chips can make. They divide a clock by eighths, and their drivers take the nearest rate without a
//! word, however far it is.

use super::super::sysfs::UsbDevice;

/// FTDI's vendor id.
const FTDI: u16 = 0x0403;

/// How far a rate may be from the one that is asked for. A receiver samples the last of ten bits half a bit from its edge,
/// so 5 % lose it; either side may spend a share of that.
const TOLERANCE: f64 = 0.02;

/// A kind of chip, by its dividers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Chip {
    /// FT2232H, FT4232H, FT232H and their successors: 12 MHz.
    HighSpeed,
    /// FT232R and all older ones: 3 MHz.
    FullSpeed,
}

impl Chip {
    /// The chip behind a port, if it is one of FTDI's.
    pub(super) fn of(device: &UsbDevice) -> Option<Self> {
        (device.vendor_id == FTDI).then_some(match device.device_version {
            0x0700 | 0x0800 | 0x0900 | 0x2800.. => Self::HighSpeed,
            _ => Self::FullSpeed,
        })
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::HighSpeed => "an FT2232H",
            Self::FullSpeed => "a full-speed FTDI chip",
        }
    }

    /// The rates that the chip makes without dividing by eighths, in falling order. The high-speed chips also have 8 Mbaud
    /// in their data sheet, and make it with jitter.
    const fn special(self) -> &'static [f64] {
        match self {
            Self::HighSpeed => &[12e6, 6e6],
            Self::FullSpeed => &[3e6, 2e6, 1.5e6],
        }
    }

    /// Whether the chip makes `baud`; if not, the nearest rates that it makes, the lower first.
    pub(super) fn check(self, baud: u32) -> Result<(), Vec<u32>> {
        let baud = f64::from(baud);
        let special = self.special();
        let close = |rate: f64| (rate - baud).abs() <= TOLERANCE * baud;
        let (mut below, mut above) = (None, None);
        for &rate in special {
            if close(rate) {
                return Ok(());
            }
            if rate > baud {
                above = Some(rate);
            } else {
                below = below.or(Some(rate));
            }
        }
        if let Some(&slowest) = special.last().filter(|&&slowest| baud < slowest) {
            // That is the clock divided by two, so 16 eighths.
            let eighths = 16.0 * slowest / baud;
            let (lower, upper) = (16.0 * slowest / eighths.ceil(), 16.0 * slowest / eighths.floor());
            if close(lower) || close(upper) {
                return Ok(());
            }
            (below, above) = (Some(lower), Some(upper));
        }
        Err(below.into_iter().chain(above).map(|rate| rate.round() as u32).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_high_speed_chip_makes_what_its_data_sheet_and_measurements_say() {
        for baud in
            [9600, 115_200, 921_600, 1_000_000, 2_000_000, 3_000_000, 4_000_000, 6_000_000, 12_000_000]
        {
            assert_eq!(Chip::HighSpeed.check(baud), Ok(()), "{baud}");
        }
        for baud in [7_000_000, 8_000_000, 9_000_000, 10_000_000, 11_000_000] {
            assert_eq!(Chip::HighSpeed.check(baud), Err(vec![6_000_000, 12_000_000]), "{baud}");
        }
        assert_eq!(Chip::HighSpeed.check(15_000_000), Err(vec![12_000_000]));
        // 96 MHz / 5.82 MHz is 16.5: 2.9 % away on either side.
        assert_eq!(Chip::HighSpeed.check(5_820_000), Err(vec![5_647_059, 6_000_000]));
    }

    #[test]
    fn a_full_speed_chip_ends_at_3_megabaud() {
        for baud in [9600, 115_200, 1_500_000, 2_000_000, 3_000_000] {
            assert_eq!(Chip::FullSpeed.check(baud), Ok(()), "{baud}");
        }
        assert_eq!(Chip::FullSpeed.check(2_500_000), Err(vec![2_000_000, 3_000_000]));
        assert_eq!(Chip::FullSpeed.check(12_000_000), Err(vec![3_000_000]));
    }

    #[test]
    fn only_ftdi_chips_are_known() {
        let device = |vendor_id, device_version| UsbDevice {
            vendor_id,
            product_id: 0x6010,
            device_version,
            manufacturer: None,
            product: None,
            serial: None,
            interface: None,
        };
        assert_eq!(Chip::of(&device(0x0403, 0x0700)), Some(Chip::HighSpeed));
        assert_eq!(Chip::of(&device(0x0403, 0x0600)), Some(Chip::FullSpeed));
        assert_eq!(Chip::of(&device(0x10c4, 0x0100)), None);
    }
}
