//! The name by which keys, quotas and what is stored are kept apart.

use std::sync::Arc;

/// Who owns sessions: a key of one tenant gives no access to those of others. Without keys there is one tenant, without
/// a name.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Tenant(Arc<str>);

impl Tenant {
    /// The tenant of a name.
    pub fn new(name: &str) -> Tenant {
        Tenant(name.into())
    }

    /// The name.
    pub fn name(&self) -> &str {
        &self.0
    }
}
