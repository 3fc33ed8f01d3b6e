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
const REST: Duration = Duration::from_millis(100);

/// A client that follows a job.
struct Follower {
    jobs: Jobs,
    id: Uuid,
    last: Option<JobReply>,
    listener: Listener,
    _share: Share,
    ended: bool,
}

impl Jobs {
    /// The progress of a job now, and then whenever it has changed, until the job has ended.
    ///
    /// # Errors
    /// [`JobError::NotFound`], [`JobError::TooManyStreams`], or a failure of the store.
    pub async fn events(&self, id: Uuid) -> Result<impl Stream<Item = StreamEvent<JobReply>> + Send + use<>, JobError> {
        let share = self.common.pool.share_of(Quota::Streams)?;
        // Before the first read, so that no change falls between it and the first wait.
        let listener = self.common.listeners.listen(self.common.store.changes(), id);
        let listener = listener.ok_or(JobError::TooManyStreams)?;
        self.find_own(id).await?;
        let (jobs, last) = (self.clone(), None);
        let follower = Follower { jobs, id, last, listener, _share: share, ended: false };
        Ok(futures::stream::unfold(follower, Follower::next))
    }

    /// Ends all events, present and future, and all work on jobs: the process is about to stop.
    pub fn end(&self) {
        self.common.listeners.end();
    }
}

impl Follower {
    async fn next(mut self) -> Option<(StreamEvent<JobReply>, Follower)> {
        if self.ended {
            return None;
        }
        if self.last.is_some() {
            self.listener.pause(REST).await;
        }
        let event = loop {
            if self.listener.is_ending() {
                break StreamEvent::End(EndReason::Stopping);
            }
            match self.jobs.get(self.id).await {
                Ok(job) if self.last.as_ref() != Some(&job) => break StreamEvent::State(job),
                Err(JobError::NotFound(_)) => break StreamEvent::End(EndReason::Deleted),
                // Whether it was woken or not, it reads again.
                Ok(_) | Err(_) => drop(timeout(LONGEST_WAIT, self.listener.wait()).await),
            }
        };
        match &event {
            StreamEvent::State(job) => {
                self.ended = job.state != JobState::Running;
                self.last = Some(job.clone());
            }
            StreamEvent::End(_) => self.ended = true,
        }
        Some((event, self))
    }
}
