/* SPDX-License-Identifier: MIT */
#include "base/jobs.h"

#include "base/ends.h"
#include "base/option.h"
#include "base/outpart.h"
#include "base/progress.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#define RESULT_MAX_B 1024 /* with its index below PIPE_BUF: a write is whole */

/* The work takes the bytes for its own structure, so they are aligned for any. */
struct message {
    union {
        long long whole;
        long double real;
        void *address;
        unsigned char bytes[RESULT_MAX_B];
    } result;
    int i;
};

int jobs_cores(void)
{
    const long n = sysconf(_SC_NPROCESSORS_ONLN);
    return n > 0 && n < JOBS_PARALLEL_MAX ? (int)n : 1;
}

/* --- interruption --- */

/* The handler's. Children come and go only while the signals are blocked, so that
 * it never misses one and never signals a stranger with a reused number. */
static volatile sig_atomic_t interrupted;
static int first_death;                /* a child's status; 0: none died */
static int no_child;                   /* errno of the last failed fork */
static pid_t child[JOBS_PARALLEL_MAX]; /* 0: free */
static void (*interrupt_work)(void);

static void on_signal(int sig)
{
    const int before = errno;
    interrupted = 1;
    ends_note(sig);
    if (interrupt_work != NULL) { interrupt_work(); }
    for (int i = 0; i < JOBS_PARALLEL_MAX; i++) {
        if (child[i] > 0) { kill(child[i], sig); }
    }
    errno = before;
}

struct handlers {
    struct sigaction interrupt, terminate; /* what was there before us */
    sigset_t both;
};

static void install(struct handlers *h, void (*interrupt)(void))
{
    struct sigaction a;
    memset(&a, 0, sizeof a);
    sigemptyset(&h->both);
    sigaddset(&h->both, SIGINT);
    sigaddset(&h->both, SIGTERM);
    a.sa_handler = on_signal;
    a.sa_mask = h->both;
    a.sa_flags = SA_RESTART;
    interrupted = 0;
    interrupt_work = interrupt;
    sigaction(SIGINT, &a, &h->interrupt);
    sigaction(SIGTERM, &a, &h->terminate);
}

static void restore(const struct handlers *h)
{
    sigaction(SIGINT, &h->interrupt, NULL);
    sigaction(SIGTERM, &h->terminate, NULL);
}

/* --- one process each --- */

static void progress(const struct jobs *j, int done)
{
    progress_show(j->label, done, j->n, done == j->n || interrupted);
}

static void run_child(const struct jobs *j, int i, int to)
{
    struct message m;
    memset(&m, 0, sizeof m);
    m.i = i;
    j->work(j->ctx, i, m.result.bytes);
    outpart_remove_all(); /* as exit() would */
    _exit(write(to, &m, sizeof m) == (ssize_t)sizeof m ? 0 : 1);
}

static int launch(const struct jobs *j, const struct handlers *h, int i, int to)
{
    int slot = 0;
    pid_t pid;
    while (slot < JOBS_PARALLEL_MAX && child[slot] != 0) { slot++; }
    if (slot == JOBS_PARALLEL_MAX) { return 0; }
    sigprocmask(SIG_BLOCK, &h->both, NULL);
    pid = fork();
    if (pid == 0) {
        memset(child, 0, sizeof child); /* they are our siblings */
        sigprocmask(SIG_UNBLOCK, &h->both, NULL);
        run_child(j, i, to);
    }
    no_child = pid < 0 ? errno : 0;
    child[slot] = pid > 0 ? pid : 0;
    sigprocmask(SIG_UNBLOCK, &h->both, NULL);
    return pid > 0;
}

/* Waits for any child: 1 success, 0 failure, -1 no child. */
static int reap(const struct handlers *h)
{
    siginfo_t info;
    int status = 1;
    if (waitid(P_ALL, 0, &info, WEXITED | WNOWAIT) != 0) { return -1; }
    sigprocmask(SIG_BLOCK, &h->both, NULL);
    waitpid(info.si_pid, &status, 0);
    for (int i = 0; i < JOBS_PARALLEL_MAX; i++) {
        if (child[i] == info.si_pid) { child[i] = 0; }
    }
    sigprocmask(SIG_UNBLOCK, &h->both, NULL);
    if (first_death == 0) { first_death = status; }
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

static int take_result(const struct jobs *j, int from)
{
    struct message m;
    if (read(from, &m, sizeof m) != (ssize_t)sizeof m || m.i < 0 || m.i >= j->n) { return 0; }
    memcpy((unsigned char *)j->result + (size_t)m.i * j->result_B, m.result.bytes, j->result_B);
    return 1;
}

/* How many jobs gave their result. */
static int run_parallel(const struct jobs *j, const struct handlers *h, const int fd[2])
{
    int started = 0, ended = 0, done = 0;
    for (;;) {
        int well;
        while (started < j->n && started - ended < j->parallel && !interrupted &&
               launch(j, h, started, fd[1])) {
            started++;
        }
        well = started > ended ? reap(h) : -1;
        if (well < 0) { return done; }
        ended++;
        done += well && take_result(j, fd[0]);
        progress(j, done);
    }
}

static int run_here(const struct jobs *j)
{
    int done = 0;
    while (done < j->n && !interrupted) {
        j->work(j->ctx, done, (unsigned char *)j->result + (size_t)done * j->result_B);
        progress(j, ++done);
    }
    return done;
}

static int complain(const struct jobs *j, int done)
{
    char why[120] = "";
    if (no_child) {
        snprintf(why, sizeof why, ": no process: %s: try a smaller --jobs", strerror(no_child));
    } else if (WIFSIGNALED(first_death)) {
        snprintf(why, sizeof why, ": the first by signal %d, %s: is it a limit of `ulimit -a`?",
            WTERMSIG(first_death), strsignal(WTERMSIG(first_death)));
    }
    cli_complain("%d of %d %s died%s", j->n - done, j->n, j->label ? j->label : "jobs", why);
    return 1;
}

int jobs_run(const struct jobs *j)
{
    struct handlers h;
    int fd[2], done;

    if (j->result_B > RESULT_MAX_B || (j->parallel > 1 && pipe(fd) != 0)) {
        cli_complain("no pipe to %d processes: try --jobs 1", j->parallel);
        return 1;
    }
    fflush(NULL);
    first_death = no_child = 0;
    install(&h, j->interrupt);
    if (j->parallel > 1) {
        done = run_parallel(j, &h, fd);
        close(fd[0]);
        close(fd[1]);
    } else {
        done = run_here(j);
    }
    restore(&h);
    if (interrupted) { return JOBS_INTERRUPTED; }
    return done < j->n ? complain(j, done) : 0;
}
