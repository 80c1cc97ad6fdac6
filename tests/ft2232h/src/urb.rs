//! The packets of USB/IP that carry URBs, as Linux's `Documentation/usb/usbip_protocol.rst` defines them: 48 bytes, big endian.

use std::io::{self, Read};

const SUBMIT: u32 = 1;
const UNLINK: u32 = 2;
const SUBMITTED: u32 = 3;
const UNLINKED: u32 = 4;

/// Bytes of a packet without its payload.
const HEADER: usize = 48;

/// The most bytes that are taken from a kernel in one URB.
const LONGEST: usize = 1 << 20;

/// The error number that ends a URB, as the kernel numbers them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub(crate) enum UrbStatus {
    Done = 0,
    /// EPIPE
    Stall = -32,
    /// EOVERFLOW
    Overflow = -75,
    /// ECONNRESET
    Unlinked = -104,
}

/// What the kernel's host controller wants.
#[derive(Debug)]
pub(crate) enum Command {
    /// A URB.
    Submit(Urb),
    /// Cancels the URB of number `which`.
    Unlink { number: u32, which: u32 },
}

/// A transfer.
#[derive(Debug)]
pub(crate) struct Urb {
    pub(crate) number: u32,
    /// With the direction bit, as in a descriptor.
    pub(crate) endpoint: u8,
    /// Bytes that the host accepts.
    pub(crate) length: usize,
    pub(crate) setup: [u8; 8],
    /// Bytes that the host sends.
    pub(crate) data: Vec<u8>,
}

impl Command {
    /// Waits for the next command.
    pub(crate) fn read(from: &mut impl Read) -> io::Result<Self> {
        let mut header = [0; HEADER];
        from.read_exact(&mut header)?;
        let word = |index: usize| u32::from_be_bytes([0, 1, 2, 3].map(|byte| header[4 * index + byte]));
        let number = word(1);
        match word(0) {
            UNLINK => Ok(Self::Unlink { number, which: word(5) }),
            SUBMIT => {
                let to_host = word(3) == 1;
                let length = word(6) as usize;
                if length > LONGEST {
                    return Err(io::ErrorKind::InvalidData.into());
                }
                let mut data = vec![0; if to_host { 0 } else { length }];
                from.read_exact(&mut data)?;
                let endpoint = word(4) as u8 | u8::from(to_host) << 7;
                let setup = [0, 1, 2, 3, 4, 5, 6, 7].map(|byte| header[40 + byte]);
                Ok(Self::Submit(Urb { number, endpoint, length, setup, data }))
            }
            _ => Err(io::ErrorKind::InvalidData.into()),
        }
    }
}

/// The completion of a URB, with `data` for one towards the host.
pub(crate) fn submitted(urb: &Urb, status: UrbStatus, moved: usize, data: &[u8]) -> Vec<u8> {
    let mut packet = reply(SUBMITTED, urb.number, status as i32, moved as u32);
    packet.extend_from_slice(data);
    packet
}

/// The answer to an unlink.
pub(crate) fn unlinked(number: u32, status: UrbStatus) -> Vec<u8> {
    reply(UNLINKED, number, status as i32, 0)
}

fn reply(code: u32, number: u32, status: i32, moved: u32) -> Vec<u8> {
    let words = [code, number, 0, 0, 0, status as u32, moved];
    let mut packet: Vec<u8> = words.into_iter().flat_map(u32::to_be_bytes).collect();
    packet.resize(HEADER, 0);
    packet
}
