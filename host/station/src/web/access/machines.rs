//! Which machines were let in, and from where.

use std::collections::HashSet;
use std::net::IpAddr;

/// The most machines and addresses that are remembered.
const MOST: usize = 1000;

/// The machines that were let in since the start, each with the address that it asked from.
#[derive(Debug, Default)]
pub(super) struct Machines(HashSet<(String, IpAddr)>);

impl Machines {
    /// Whether the audit has the machine of this name from this address.
    pub(super) fn has(&self, name: &str, peer: IpAddr) -> bool {
        self.0.contains(&(name.to_owned(), peer))
    }

    /// Notes that the audit has it. When too many are remembered, all are forgotten: the audit has a line twice rather than not
    /// at all.
    pub(super) fn note(&mut self, name: String, peer: IpAddr) {
        if self.0.len() >= MOST {
            self.0.clear();
        }
        self.0.insert((name, peer));
    }
}

#[cfg(test)]
mod tests {
    use std::net::Ipv4Addr;

    use super::*;

    #[test]
    fn a_machine_is_remembered_however_many_there_were() {
        let mut machines = Machines::default();
        for number in 0..=MOST {
            let peer = IpAddr::V4(Ipv4Addr::from_bits(u32::try_from(number).unwrap()));
            assert!(!machines.has("mes", peer), "it never asked from {peer}");
            machines.note("mes".to_owned(), peer);
            assert!(machines.has("mes", peer) && !machines.has("other", peer), "{peer}");
        }
        assert!(machines.0.len() <= MOST);
    }
}
