//! Consistent overhead byte stuffing: no zero inside a packet, so a zero always ends one.
//! At most one byte is added for every 254.

use alloc::vec::Vec;

/// The longest run of bytes that one code byte announces.
const RUN: usize = 254;

/// The most bytes that `length` bytes become by stuffing.
pub(crate) const fn stuffed_length(length: usize) -> usize {
    length.saturating_add(length / RUN + 1)
}

/// Appends `bytes`, stuffed, to `wire`.
pub(crate) fn stuff(bytes: &[u8], wire: &mut Vec<u8>) {
    let mut rest = bytes;
    loop {
        let reach = &rest[..rest.len().min(RUN)];
        let run = memchr::memchr(0, reach).unwrap_or(reach.len());
        let ends_in_zero = run < reach.len();
        #[expect(clippy::cast_possible_truncation, reason = "a run has at most 254 bytes")]
        wire.push(run as u8 + 1);
        wire.extend_from_slice(&rest[..run]);
        rest = &rest[run + usize::from(ends_in_zero)..];
        // A zero in the last place is followed by an empty run; a full run at the very end is followed by nothing.
        if rest.is_empty() && !ends_in_zero {
            return;
        }
    }
}

/// Appends the bytes that were stuffed as `bytes` to `plain`. `None` if `bytes` is not valid stuffing.
pub(crate) fn unstuff(mut bytes: &[u8], plain: &mut Vec<u8>) -> Option<()> {
    while let Some((&code, rest)) = bytes.split_first() {
        let run = usize::from(code).checked_sub(1)?;
        plain.extend_from_slice(rest.get(..run)?);
        bytes = &rest[run..];
        if run < RUN && !bytes.is_empty() {
            plain.push(0);
        }
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;

    fn check(plain: &[u8], stuffed: &[u8]) {
        let mut wire = Vec::new();
        stuff(plain, &mut wire);
        assert_eq!(wire, stuffed);
        assert_eq!(unstuffed(&wire).unwrap(), plain);
    }

    fn unstuffed(bytes: &[u8]) -> Option<Vec<u8>> {
        let mut plain = Vec::new();
        unstuff(bytes, &mut plain).map(|()| plain)
    }

    // The examples of Cheshire and Baker's paper as they are commonly tabulated.
    #[test]
    fn the_published_examples_hold() {
        check(&[0], &[1, 1]);
        check(&[0, 0], &[1, 1, 1]);
        check(&[0, 0x11, 0], &[1, 2, 0x11, 1]);
        check(&[0x11, 0x22, 0, 0x33], &[3, 0x11, 0x22, 2, 0x33]);
        check(&[0x11, 0, 0, 0], &[2, 0x11, 1, 1, 1]);
        let to_fe: Vec<u8> = (1..=0xfe).collect();
        check(&to_fe, &[&[0xff], &to_fe[..]].concat());
        check(&[&[0], &to_fe[..]].concat(), &[&[1, 0xff], &to_fe[..]].concat());
        check(&[&to_fe[..], &[0xff]].concat(), &[&[0xff], &to_fe[..], &[2, 0xff]].concat());
        let to_ff: Vec<u8> = (2..=0xff).collect();
        check(&[&to_ff[..], &[0]].concat(), &[&[0xff], &to_ff[..], &[1, 1]].concat());
    }

    #[test]
    fn what_no_stuffing_makes_is_refused() {
        assert_eq!(unstuffed(&[3, 1]), None);
        assert_eq!(unstuffed(&[2, 1, 0, 1]), None);
    }

    proptest::proptest! {
        #[test]
        fn any_bytes_come_back_without_a_zero_between(plain in proptest::collection::vec(proptest::prelude::any::<u8>(), 0..1200)) {
            let mut wire = vec![];
            stuff(&plain, &mut wire);
            assert!(!wire.contains(&0) && wire.len() <= stuffed_length(plain.len()));
            assert_eq!(unstuffed(&wire), Some(plain));
        }
    }
}
