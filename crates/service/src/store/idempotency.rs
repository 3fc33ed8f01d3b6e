//! Retries: a request with an idempotency key that has been answered gets the same reply again.
//!
//! Only replies to what succeeded are stored. A failed call has changed nothing, so that a retry may be computed anew.

use super::{Receipt, Reply, RequestKey, Result, Store, StoreError, Tenant};

/// A request that may have been answered before.
pub struct IdempotentRequest<'a> {
    store: &'a dyn Store,
    key: Option<RequestKey>,
}

impl<'a> IdempotentRequest<'a> {
    /// A request of a tenant, with its idempotency key if it has one.
    pub fn new(store: &'a dyn Store, tenant: &Tenant, key: Option<RequestKey>) -> IdempotentRequest<'a> {
        IdempotentRequest { store, key: key.map(|key| key.for_tenant(tenant)) }
    }

    /// The reply that an earlier request with the same key got.
    ///
    /// # Errors
    /// [`StoreError::KeyReused`], or a failure of the store.
    pub async fn earlier_reply(&self) -> Result<Option<Reply>> {
        let Some(key) = &self.key else { return Ok(None) };
        match self.store.receipt(&key.key).await? {
            None => Ok(None),
            Some(receipt) if receipt.request.fingerprint == key.fingerprint => Ok(Some(receipt.reply)),
            Some(_) => Err(StoreError::KeyReused),
        }
    }

    /// The receipt to be stored with the change that a reply is about.
    pub fn receipt(&self, reply: &Reply) -> Option<Receipt> {
        self.key.clone().map(|request| Receipt { request, reply: reply.clone() })
    }

    /// The reply to a request whose change the store refused: if the same request, sent twice, was faster elsewhere,
    /// its reply.
    ///
    /// # Errors
    /// As [`IdempotentRequest::earlier_reply`], or `error` itself if no reply is kept.
    pub async fn after_refusal(&self, error: StoreError) -> Result<Reply> {
        let earlier = if matches!(error, StoreError::KeyTaken) { self.earlier_reply().await? } else { None };
        earlier.ok_or(error)
    }
}
