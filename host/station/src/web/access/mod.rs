//! Who may see and do what.

mod address;

use std::net::SocketAddr;

pub use address::{Address, AddressError};

use super::visit::User;

/// Where the pages are, and who may see and do what there.
#[derive(Debug)]
pub struct Access {
    address: Address,
    /// Who everybody is without having logged in.
    everybody: Option<User>,
}

impl Access {
    /// For pages at `address`, where everybody is `everybody`.
    #[must_use]
    pub fn open(address: Address, everybody: User) -> Self {
        Self { address, everybody: Some(everybody) }
    }

    /// With the port that the system gave for port 0.
    #[must_use]
    pub fn at(self, port: u16) -> Self {
        Self { address: self.address.at(port), ..self }
    }

    /// Where the pages are served.
    #[must_use]
    pub fn listen(&self) -> SocketAddr {
        self.address.listen
    }

    pub(super) fn address(&self) -> &Address {
        &self.address
    }

    pub(super) fn everybody(&self) -> Option<&User> {
        self.everybody.as_ref()
    }
}
