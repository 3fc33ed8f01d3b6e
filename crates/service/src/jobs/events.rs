//! Following a job: its progress, whenever that has changed.

use std::time::Duration;

use futures::Stream;
use tokio::time::timeout;
use uuid::Uuid;

use crate::admission::{Quota, Share};
use crate::store::{Listener, StreamEvent};
use stickslip_wire::{EndReason, JobReply, JobState};

use super::{JobError, Jobs};

/// How long a follower waits at most before it reads again: not every change by another process is announced.
const LONGEST_WAIT: Duration = Duration::from_secs(1);
/// The shortest time between two events: chunks may be finished faster than a client reads.
const RETRY_DELAY: Duration = Duration::from_millis(100);

struct Follower {
    jobs: Jobs,
    id: Uuid,
    last: Option<JobReply>,
    listener: Listener,
    /// Whether the last attempt to read it has failed.
    has_failed: bool,
    _share: Share,
}

impl Jobs {
    /// The progress of a job now, and then whenever it has changed, until the job has ended.
    ///
    /// # Errors
    /// [`JobError::NotFound`], [`JobError::TooManyStreams`], or a failure of the store.
    pub async fn events(&self, id: Uuid) -> Result<impl Stream<Item = StreamEvent<JobReply>> + Send + use<>, JobError> {
        let share = self.common.pool.share_of(Quota::Streams)?;
        // Before the first read, so that no change falls between it and the first wait.
        let place = self.common.listeners.place().ok_or(JobError::TooManyStreams)?;
        let listener = self.common.listeners.listen(place, self.common.store.changes().subscribe(id));
        self.find_own(id).await?;
        let (jobs, last) = (self.clone(), None);
        let follower = Follower { jobs, id, last, listener, has_failed: false, _share: share };
        Ok(futures::stream::unfold(Some(follower), async |follower| Some(follower?.next().await)))
    }

    /// Ends all events, present and future, and all work on jobs: the process is about to stop.
    pub fn end(&self) {
        self.common.listeners.end();
    }
}

impl Follower {
    /// The next event, and what follows it unless it is the last.
    async fn next(mut self) -> (StreamEvent<JobReply>, Option<Follower>) {
        if self.last.is_some() {
            self.listener.pause(RETRY_DELAY).await;
        }
        let event = loop {
            if self.listener.is_ending() {
                break StreamEvent::End(EndReason::Stopping);
            }
            match self.jobs.get(self.id).await {
                Ok(job) if self.last.as_ref() != Some(&job) => break StreamEvent::State(job),
                Err(JobError::NotFound(_)) => break StreamEvent::End(EndReason::Deleted),
                Ok(_) => self.has_failed = false,
                Err(JobError::Store(error)) if error.is_transient() => {
                    if !self.has_failed {
                        tracing::warn!(job = %self.id, %error, "events are delayed: the store cannot be read");
                    }
                    self.has_failed = true;
                }
                Err(error) => {
                    tracing::error!(job = %self.id, %error, "events end: the job cannot be read");
                    break StreamEvent::End(EndReason::Failed);
                }
            }
            // Whether it was woken or not, it reads again.
            let _ = timeout(LONGEST_WAIT, self.listener.wait()).await;
        };
        self.last = if let StreamEvent::State(job) = &event { Some(job.clone()) } else { None };
        let runs = self.last.as_ref().is_some_and(|job| job.state == JobState::Running);
        (event, runs.then_some(self))
    }
}
