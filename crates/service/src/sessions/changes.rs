//! Making, copying, naming and deleting sessions.

use std::pin::{Pin, pin};

use jiff::Timestamp;

use crate::store::{CONTACT_BYTES, IdempotentRequest, LabelChange, Reply, RequestKey, Session, Usage};
use stickslip_wire::session::Creation;
use stickslip_wire::{ForkRequest, SessionReply};

use super::common::ATTEMPTS;
use super::expected::Expected;
use super::prelude::*;
use super::run_to_end::run_to_end;

impl Sessions {
    /// Makes a session.
    ///
    /// # Errors
    /// [`SessionError`]; nothing has been made then.
    pub async fn create(&self, creation: Creation, key: Option<RequestKey>) -> Result<Reply, SessionError> {
        let request = self.request(key);
        let create = pin!(async {
            let now = Timestamp::now();
            let session = Session {
                id: Uuid::now_v7(),
                tenant: self.tenant.clone(),
                label: creation.label,
                definition: Arc::new(creation.definition),
                sequence: 0,
                created_at: now,
                updated_at: now,
            };
            let live = LoadedSession::start(session, creation.setup)?;
            let reply = live.created_reply()?;
            let receipt = request.receipt(&reply);
            let added = Usage::of(1, live.stored_bytes(), receipt.as_ref());
            let reservation = self.reserve_storage(added).await?;
            // A request that finds the new session in the store waits until it is cached.
            let id = live.session.id;
            let guard = self.entries.enter(&self.tenant, id).lock().await;
            let (common, version) = (Arc::clone(&self.common), self.store.changes().version(id));
            let create = async move {
                common.store.create(live.session.clone(), receipt).await?;
                reservation.used(added);
                guard.finish(Box::new(live), version);
                Ok::<_, StoreError>(reply)
            };
            Ok(run_to_end(create).await?)
        });
        answer_once(&request, create).await
    }

    /// The reply to an earlier request with this key.
    ///
    /// # Errors
    /// A key of another request, or a failure of the store.
    pub async fn earlier_reply(&self, key: RequestKey) -> Result<Option<Reply>, SessionError> {
        Ok(self.request(Some(key)).earlier_reply().await?)
    }

    /// Keeps the reply to a request that stores nothing else, within the quotas of the tenant. Returns the reply that
    /// is kept: that to the same request, sent twice, if it was faster.
    ///
    /// # Errors
    /// A key of another request, a quota, or a failure of the store.
    pub async fn keep_reply(&self, key: RequestKey, body: Vec<u8>) -> Result<Reply, SessionError> {
        let request = self.request(Some(key));
        let reply = Reply { created: None, sequence: 0, body };
        let Some(receipt) = request.receipt(&reply) else { return Ok(reply) };
        let added = Usage::of(0, 0, Some(&receipt));
        let reservation = self.reserve_storage(added).await?;
        let common = Arc::clone(&self.common);
        let keep = async move { common.store.keep(receipt).await.inspect(|()| reservation.used(added)) };
        match run_to_end(keep).await {
            Ok(()) => Ok(reply),
            Err(error) => Ok(request.after_refusal(error).await?),
        }
    }

    /// Makes a session with the same moves, or with the first of them.
    ///
    /// # Errors
    /// [`SessionError`]; nothing has been made then.
    pub async fn fork(&self, id: Uuid, asked: ForkRequest, key: Option<RequestKey>) -> Result<Reply, SessionError> {
        let request = self.request(key);
        let fork = pin!(async {
            // A tenant at its quota is refused before its past is read.
            drop(self.reserve_storage(Usage::of(1, CONTACT_BYTES, None)).await?);
            let mut guard = self.lock(id).await?;
            let (mut copy, held) = self.after(&mut guard, asked.sequence).await?;
            let now = Timestamp::now();
            copy.session = Session {
                id: Uuid::now_v7(),
                label: asked.label.or(copy.session.label),
                created_at: now,
                updated_at: now,
                ..copy.session
            };
            let reply = copy.created_reply()?;
            let receipt = request.receipt(&reply);
            let extent = self.store.extent(id).await;
            let extent = extent.map_err(|error| self.store_failure(&mut guard, error))?;
            let moves = copy.session.sequence * self.store.move_bytes();
            let added = Usage::of(1, copy.stored_bytes() + moves + extent.snapshot, receipt.as_ref());
            let reservation = self.reserve_storage(added).await?;
            let new = self.entries.enter(&self.tenant, copy.session.id).lock().await;
            // The original may have moved on meanwhile in another process: its past stays what it was.
            let (common, version) = (Arc::clone(&self.common), self.store.changes().version(copy.session.id));
            let fork = async move {
                let _held = held;
                common.store.fork(id, copy.session.clone(), receipt).await?;
                reservation.used(added);
                new.finish(copy, version);
                Ok(())
            };
            match run_to_end(fork).await {
                Ok(()) => Ok(reply),
                Err(error @ (StoreError::NotFound | StoreError::Expired(_))) => {
                    Err(self.store_failure(&mut guard, error))
                }
                Err(StoreError::Stale { found }) => Err(SessionError::Overtaken { found }),
                Err(error) => Err(error.into()),
            }
        });
        answer_once(&request, fork).await
    }

    /// Gives a session another label, or none, if it is at the sequence that the client expects, where it stays.
    ///
    /// # Errors
    /// [`SessionError`]; its label stays then.
    pub async fn rename(
        &self,
        id: Uuid,
        label: Option<String>,
        expected: Option<Expected>,
        key: Option<RequestKey>,
    ) -> Result<Reply, SessionError> {
        let request = self.request(key);
        let rename = pin!(async {
            let mut guard = self.lock(id).await?;
            let mut overtaken = 0;
            for _ in 0..ATTEMPTS {
                let now = self.current(&mut guard).await?.reply();
                if let Some(expected) = expected {
                    expected.check(now.sequence, now.label.as_deref())?;
                }
                let change = LabelChange { from: now.label.clone(), to: label.clone() };
                let renamed = SessionReply { label: label.clone(), ..now };
                let reply = Reply { created: None, sequence: renamed.sequence, body: written(&renamed)? };
                let receipt = request.receipt(&reply);
                let added = Usage::of(0, 0, receipt.as_ref());
                let reservation = self.reserve_storage(added).await?;
                // The reply shows the sequence, and the client may expect it and the label: both hold only as long as
                // no other process changes them.
                let (common, at) = (Arc::clone(&self.common), reply.sequence);
                let rename = async move {
                    let renamed = common.store.rename(id, change, at, receipt).await;
                    renamed.inspect(|()| reservation.used(added))
                };
                match run_to_end(rename).await {
                    Ok(()) => {
                        // The change itself counts.
                        guard.version = guard.version.map(|version| version.saturating_add(1));
                        guard.live.iter_mut().for_each(|live| live.session.label = label.clone());
                        return Ok(reply);
                    }
                    Err(StoreError::Stale { found }) => overtaken = found,
                    Err(error) => return Err(self.store_failure(&mut guard, error)),
                }
            }
            Err(SessionError::Overtaken { found: overtaken })
        });
        answer_once(&request, rename).await
    }

    /// Deletes a session, if it is at the sequence that the client expects.
    ///
    /// # Errors
    /// [`SessionError`]; it is still there then.
    pub async fn delete(&self, id: Uuid, expected: Option<Expected>) -> Result<(), SessionError> {
        let mut guard = self.lock(id).await?;
        let found = match &guard.live {
            Some(live) if expected.is_none_or(|expected| expected.label.is_none()) => live.session.sequence,
            _ => {
                let stored = self.extent(id).await?;
                expected.map_or(Ok(()), |expected| expected.check(stored.sequence, stored.label.as_deref()))?;
                stored.sequence
            }
        };
        let mut at = expected.map_or(found, |expected| expected.sequence);
        for _ in 0..ATTEMPTS {
            let (tenant, common) = (self.tenant.clone(), Arc::clone(&self.common));
            let delete = async move {
                let deleted = common.store.delete(id, at).await;
                if deleted.is_ok() {
                    guard.live = None;
                    let bytes = CONTACT_BYTES + at * common.store.move_bytes();
                    common.give_back(&tenant, Usage::of(1, bytes, None));
                }
                (guard, deleted)
            };
            let deleted;
            (guard, deleted) = run_to_end(delete).await;
            match (deleted, expected) {
                (Ok(()), _) => return Ok(()),
                (Err(StoreError::Stale { found }), Some(expected)) => {
                    return Err(SessionError::Stale { expected: expected.sequence, found });
                }
                (Err(StoreError::Stale { found }), None) => at = found,
                (Err(error), _) => return Err(self.store_failure(&mut guard, error)),
            }
        }
        Err(SessionError::Overtaken { found: at })
    }
}

/// The reply to a request: that to an earlier one with the same key, even if the session has been deleted or has moved
/// on, or else the outcome of its work. One that is refused may be refused for what the same request, sent twice, has
/// changed elsewhere meanwhile: then it gets the reply to that one.
pub(super) async fn answer_once(
    request: &IdempotentRequest<'_>,
    work: Pin<&mut impl Future<Output = Result<Reply, SessionError>>>,
) -> Result<Reply, SessionError> {
    if let Some(reply) = request.earlier_reply().await? {
        return Ok(reply);
    }
    match work.await {
        Err(SessionError::Store(error)) => Ok(request.after_refusal(error).await?),
        Err(refusal) => request.earlier_reply().await?.ok_or(refusal),
        done => done,
    }
}
