#include "jobs.h"

#include <stdio.h>
#include <string.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#define RESULT_MAX_B 1024 /* with its index below PIPE_BUF: a write is whole */

struct message {
    int i;
    unsigned char bytes[RESULT_MAX_B];
};

int jobs_cores(void)
{
    const long n = sysconf(_SC_NPROCESSORS_ONLN);
    return n > 0 && n < 1024 ? (int)n : 1;
}

static void progress(const struct jobs *j, int done)
{
    if (j->label == NULL || !isatty(2)) { return; }
    fprintf(stderr, "\r%s: %d/%d%s", j->label, done, j->n, done == j->n ? "\n" : "");
    fflush(stderr);
}

static void child(const struct jobs *j, int i, int to)
{
    struct message m;
    memset(&m, 0, sizeof m);
    m.i = i;
    j->work(j->ctx, i, m.bytes);
    _exit(write(to, &m, sizeof m) == (ssize_t)sizeof m ? 0 : 1);
}

static int launch(const struct jobs *j, int i, int to)
{
    const pid_t pid = fork();
    if (pid == 0) { child(j, i, to); }
    return pid > 0;
}

static int run_here(const struct jobs *j)
{
    for (int i = 0; i < j->n; i++) {
        j->work(j->ctx, i, (unsigned char *)j->result + (size_t)i * j->result_B);
        progress(j, i + 1);
    }
    return 0;
}

int jobs_run(const struct jobs *j)
{
    int fd[2];
    int started = 0, done = 0, failed = 0;

    if (j->parallel <= 1) { return run_here(j); }
    if (j->result_B > RESULT_MAX_B || pipe(fd) != 0) {
        fprintf(stderr, "jobs: no pipe: try --jobs 1\n");
        return 1;
    }
    fflush(NULL);
    while (done + failed < j->n) {
        int status;
        while (started < j->n && started - done - failed < j->parallel) {
            if (!launch(j, started, fd[1])) { break; }
            started++;
        }
        if (started == done + failed || wait(&status) < 0) {
            failed = j->n - done;
            break;
        }
        if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
            struct message m;
            if (read(fd[0], &m, sizeof m) != (ssize_t)sizeof m) { break; }
            memcpy((unsigned char *)j->result + (size_t)m.i * j->result_B, m.bytes, j->result_B);
            done++;
        } else {
            failed++;
        }
        progress(j, done);
    }
    close(fd[0]);
    close(fd[1]);
    if (failed) { fprintf(stderr, "jobs: %d of %d did not finish\n", failed, j->n); }
    return failed != 0;
}
