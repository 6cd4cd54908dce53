/* SPDX-License-Identifier: Apache-2.0
 *
 * The lease protocol of proto/skinframe/v1/worker.proto and server/jobs/decisions.h, for one job, as a model for
 * the checker SPIN. Every interleaving of a client, two workers, the reaper, and of a server that may crash
 * between any two steps is tried; calls and their answers get lost, come twice, come late and in any order.
 *
 *   durable   what one transaction of the store writes; survives the server's crash
 *   volatile  what the server knows beside it
 *   ghost     what only the properties look at
 *
 * Time: a lease has run out when `fresh` has been taken away since the last heartbeat, which can happen at any
 * moment. So no property rests on how long anything takes, nor on whether a heartbeat without news prolongs the
 * lease, nor on how far a cancellation shortens it.
 *
 * Properties
 *   safe   no acknowledged job is lost; a repeated submission makes no second job; no result of an attempt that
 *          is over is accepted, and none twice (assertions); what has ended stays as it ended; a cancelled job is
 *          never queued again; no checkpoint of an attempt that is over is kept, and none beyond the end
 *   ends   every acknowledged job ends (weak fairness: whoever can go on does so some time)
 *
 * A property that cannot fail proves nothing: each of these defects, by -D, must be caught (check.sh).
 *   NO_FENCE               a completion is judged by the job's state alone
 *   TOKEN_PER_PROCESS      tokens are counted in the server's memory and begin again after its crash
 *   ACK_BEFORE_COMMIT      the submission is acknowledged before it is durable
 *   NO_REQUEST_ID          a repeated submission makes a job of its own
 *   QUEUE_IN_MEMORY        what is queued is known to the process alone
 *   LOSSES_DO_NOT_COUNT    a lost attempt does not count, so that a job that kills its workers goes on for ever
 *   CANCEL_IS_FORGOTTEN    the reaper queues a job again although its user has cancelled it
 *   UNDELIVERED_FORGETS    so does the server when a job did not reach its worker
 *   NO_CHECKPOINT_FENCE    a checkpoint is judged by the job's state alone
 *   CHECKPOINT_IS_LEFT     the end of a job leaves its checkpoint behind, so that the cleaner keeps it for ever
 */

#define MAX_ATTEMPTS 2
#define WORKERS 2
#define MAX_SERVER_CRASHES 1
#define MAX_HAND_BACKS 1   /* a worker that stops in good order costs no attempt: it must not stop for ever */
#define MAX_HEARTBEATS 1   /* of one attempt: the work itself ends */
#define MAX_SUBMISSIONS 2
#define MOST_LEASES 6      /* numbers begin again after it: more than a job can have, but with LOSSES_DO_NOT_COUNT */

mtype = { absent, queued, running, succeeded, failed, cancelled };
mtype = { result_kept, result_failed, result_retryable, handed_back, undelivered };

#define ended(s) (s == succeeded || s == failed || s == cancelled)

/* durable */
mtype state = absent;
byte token = 0;            /* of the current attempt */
byte tokens_given = 0;
byte lost = 0;
bool cancel_requested = false;
bool checkpoint = false;   /* the job refers to one; over the loss of an attempt it stays */

/* volatile */
bool in_queue = false;     /* QUEUE_IN_MEMORY only */
bool fresh = false;

/* ghost */
bool acknowledged = false;
byte jobs_made = 0;
byte attempt = 0;          /* counts the leases, whatever their tokens say */
bool accepted = false;     /* a result was taken */
byte hand_backs = 0;
mtype ended_as = absent;

/* Completions on their way: token, attempt, what it says. Taken in any order. */
chan network = [2] of { byte, byte, mtype };

inline end_as(s) {
  state = s;
#ifndef CHECKPOINT_IS_LEFT
  checkpoint = false;
#endif
  assert(ended_as == absent);
  ended_as = s
}

inline queue_again() {
  state = queued;
  in_queue = true
}

inline lose_attempt() {
#ifndef LOSSES_DO_NOT_COUNT
  lost++;
#endif
  if
#ifndef CANCEL_IS_FORGOTTEN
  :: cancel_requested -> end_as(cancelled)
  :: else ->
#else
  :: true ->
#endif
    if
    :: lost >= MAX_ATTEMPTS -> end_as(failed)
    :: else -> queue_again()
    fi
  fi
}

/* Submits, and again while no acknowledgement has come. */
active proctype Client() {
  byte submissions = 0;
  do
  :: atomic { !acknowledged && submissions < MAX_SUBMISSIONS ->
       submissions++;
#ifdef ACK_BEFORE_COMMIT
       acknowledged = true;
       if
       :: true -> skip     /* the server crashes here */
       :: true -> state = queued; in_queue = true; jobs_made++
       fi
#else
       if
       :: true -> skip     /* the call never arrives */
       :: true ->
#ifdef NO_REQUEST_ID
         jobs_made++;
         if
         :: state == absent -> state = queued; in_queue = true
         :: else -> skip   /* the second job lives beside this one */
         fi;
#else
         if
         :: state == absent -> state = queued; in_queue = true; jobs_made++
         :: else -> skip   /* the request id is known: the same job */
         fi;
#endif
         if
         :: acknowledged = true
         :: skip           /* the answer gets lost */
         fi
       fi
#endif
     }
  :: else -> break
  od;
  if
  :: atomic { state == queued -> cancel_requested = true; end_as(cancelled) }
  :: atomic { state == running -> cancel_requested = true }
  :: true -> skip
  fi
}

active [WORKERS] proctype Worker() {
  byte my_token;
  byte my_attempt;
  byte heartbeats;
  bool kept;
  bool holds;
idle:
  my_token = 0; my_attempt = 0; heartbeats = 0; kept = false; holds = false;
  /* Lease: one transaction looks for a queued job and gives it. */
  end_idle: atomic {
#ifdef QUEUE_IN_MEMORY
    state == queued && in_queue ->
#else
    state == queued ->
#endif
    in_queue = false;
    tokens_given = tokens_given % MOST_LEASES + 1;
    token = tokens_given;
    state = running;
    fresh = true;
    attempt = attempt % MOST_LEASES + 1;
    if
    :: my_token = token; my_attempt = attempt; holds = true
    :: skip                /* the answer gets lost: nobody works, and the lease runs out */
    :: hand_backs < MAX_HAND_BACKS && nfull(network) ->   /* or the server sees that the worker has hung up */
       hand_backs++; network!token, attempt, undelivered
    fi
  }
  if
  :: !holds -> goto idle
  :: else -> skip
  fi;
work:
  if
  :: atomic { heartbeats < MAX_HEARTBEATS -> heartbeats++;
       if
       :: state == running && token == my_token ->
         if
         :: cancel_requested -> skip   /* no longer prolonged */
         :: else -> fresh = true
         fi
       :: else -> holds = false        /* ABORTED: drop it */
       fi }
     if
     :: holds -> goto work
     :: else -> goto idle
     fi
  :: atomic { !kept -> kept = true;      /* decide_checkpoint; it may come long after the lease */
       if
#ifdef NO_CHECKPOINT_FENCE
       :: state == running ->
#else
       :: state == running && token == my_token ->
#endif
         assert(my_attempt == attempt);
         checkpoint = true
       :: else -> skip                 /* ABORTED: its heartbeat will hear of it */
       fi }
     goto work
  :: goto idle             /* crashes; the one that comes after it knows nothing of the job */
  :: atomic { nfull(network) ->
       if
       :: network!my_token, my_attempt, result_kept
       :: network!my_token, my_attempt, result_failed
       :: network!my_token, my_attempt, result_retryable
       :: hand_backs < MAX_HAND_BACKS -> hand_backs++; network!my_token, my_attempt, handed_back
       fi }
     goto idle             /* answered, or given up; what it sent may come twice: see Completions */
  fi
}

/* decide_complete, one transaction. */
active proctype Completions() {
  byte t;
  byte a;
  mtype says;
  end_waits: do
  :: atomic {
       if                  /* any of those on their way; a copy may come later */
       :: network??t, a, says
       :: network??<t, a, says>
       fi;
       if
#ifdef NO_FENCE
       :: state == running ->
#else
       :: state == running && token == t && t != 0 ->
#endif
         if
         :: says == handed_back && !cancel_requested -> queue_again()
         :: says == handed_back && cancel_requested -> lose_attempt()
         :: says == undelivered && !cancel_requested -> queue_again()
         :: says == undelivered && cancel_requested ->
#ifdef UNDELIVERED_FORGETS
           queue_again()
#else
           fresh = false   /* the reaper ends it */
#endif
         :: says == result_retryable -> lose_attempt()
         :: says == result_kept ->
           assert(a == attempt);
           assert(!accepted); accepted = true;
           end_as(succeeded)
         :: says == result_failed ->
           assert(a == attempt);
           assert(!accepted); accepted = true;
           end_as(failed)
         fi
       :: else -> skip     /* repeated: nothing; stale: ABORTED */
       fi;
       t = 0; a = 0; says = handed_back
     }
  :: atomic { network??t, a, says -> t = 0; a = 0; says = handed_back }   /* gets lost */
  od
}

/* Time passes; then the reaper's transaction. */
active proctype Reaper() {
  end_rests: do
  :: atomic { state == running && fresh -> fresh = false }
  :: atomic { state == running && !fresh -> lose_attempt() }
  od
}

active proctype ServerCrash() {
  byte crashes = 0;
  end_runs: do
  :: atomic { crashes < MAX_SERVER_CRASHES ->
       crashes++;
       in_queue = false;
       fresh = true;       /* after a start the reaper is patient for one lease's time */
#ifdef TOKEN_PER_PROCESS
       tokens_given = 0;
#endif
     }
  od
}

ltl safe { [] ((acknowledged -> state != absent) && jobs_made <= 1 && (ended_as != absent -> state == ended_as) &&
               !(cancel_requested && state == queued) && (ended_as != absent -> !checkpoint)) }
ltl ends { [] (acknowledged -> <> ended(state)) }
