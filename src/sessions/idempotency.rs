//! Retries: a request with an idempotency key that has been answered gets the same answer again.
//!
//! Only replies to what succeeded are kept. A failed call has changed nothing, so that a retry may as well try.

use crate::store::{Receipt, Reply, RequestKey, StoreError};

use super::{SessionError, Sessions};

impl Sessions {
    /// The reply that an earlier request with the same key got.
    pub(super) async fn earlier(&self, request: Option<&RequestKey>) -> Result<Option<Reply>, SessionError> {
        let Some(request) = request else {
            return Ok(None);
        };
        match self.common.store.receipt(&request.key).await.map_err(SessionError::Store)? {
            None => Ok(None),
            Some(receipt) if receipt.request.fingerprint == request.fingerprint => Ok(Some(receipt.reply)),
            Some(_) => Err(SessionError::KeyReused),
        }
    }

    /// What is owed to a request whose change the store refused: where a twin of it was faster, the twin's reply.
    pub(super) async fn lost(&self, error: StoreError, request: Option<RequestKey>) -> Result<Reply, SessionError> {
        match error {
            StoreError::KeyTaken => {
                let earlier = self.earlier(request.as_ref()).await?;
                earlier.ok_or(SessionError::Store(StoreError::KeyTaken))
            }
            other => Err(SessionError::Store(other)),
        }
    }
}

/// The receipt of a reply, if the request has a key.
pub(super) fn receipt(request: Option<RequestKey>, reply: &Reply) -> Option<Receipt> {
    request.map(|request| Receipt { request, reply: reply.clone() })
}
