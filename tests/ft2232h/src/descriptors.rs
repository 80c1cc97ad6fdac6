//! The descriptors of an FT2232H with an EEPROM.

/// The device: USB 2.0, packets of 64 bytes at endpoint 0, FTDI's FT2232H of revision 7.00, strings 1 to 3.
pub(crate) const DEVICE: [u8; 18] =
    [18, 1, 0x00, 0x02, 0, 0, 0, 64, 0x03, 0x04, 0x10, 0x60, 0x00, 0x07, 1, 2, 3, 1];

/// One configuration of two interfaces, bus powered, with packets of `packet` bytes.
#[rustfmt::skip]
pub(crate) fn configuration(packet: u16) -> [u8; 55] {
    let [low, high] = packet.to_le_bytes();
    [
        9, 2, 55, 0, 2, 1, 0, 0x80, 250,
        9, 4, 0, 0, 2, 0xff, 0xff, 0xff, 2,
        7, 5, 0x81, 2, low, high, 0,
        7, 5, 0x02, 2, low, high, 0,
        9, 4, 1, 0, 2, 0xff, 0xff, 0xff, 2,
        7, 5, 0x83, 2, low, high, 0,
        7, 5, 0x04, 2, low, high, 0,
    ]
}

/// String 0: the only language is English.
pub(crate) const LANGUAGES: [u8; 4] = [4, 3, 0x09, 0x04];

/// A string descriptor.
pub(crate) fn string(text: &str) -> Vec<u8> {
    let units: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    [&[units.len() as u8 + 2, 3], units.as_slice()].concat()
}
