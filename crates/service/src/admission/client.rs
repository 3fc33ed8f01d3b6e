//! Whose request is being served: whom threads, memory and quotas are shared between.

use std::future::Future;
use std::net::{IpAddr, Ipv6Addr};
use std::sync::Arc;

use super::Admission;
use crate::tenant::Tenant;

/// One of those who share the server.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Client {
    /// The server itself.
    Server,
    /// An address, where there are no keys; see [`Client::of_address`].
    Address(IpAddr),
    /// The holders of the keys of a tenant.
    Tenant(Tenant),
}

impl Client {
    /// The client of an address: an IPv6 client owns a whole /64 network.
    pub fn of_address(address: IpAddr) -> Client {
        Client::Address(match address.to_canonical() {
            IpAddr::V6(address) => {
                let [a, b, c, d, ..] = address.segments();
                Ipv6Addr::new(a, b, c, d, 0, 0, 0, 0).into()
            }
            address => address,
        })
    }

    /// The client that this task serves.
    pub fn current() -> Client {
        Admission::current().map_or(Client::Server, |admission| admission.client.clone())
    }

    /// Does a piece of work that does not wait on behalf of this client.
    pub fn within<T>(&self, work: impl FnOnce() -> T) -> T {
        Arc::new(Admission::of(self.clone())).within(work)
    }

    /// Does the work on behalf of this client.
    pub fn serve<F: Future>(self, work: F) -> impl Future<Output = F::Output> {
        Arc::new(Admission::of(self)).serve(work)
    }
}
