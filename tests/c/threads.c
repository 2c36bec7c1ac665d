/* Two threads, each with an instance of its own, and one library: no race, the same bits in both. Built
 * with gcc -Wall -Wextra -Werror, run plain and under helgrind.
 *
 *   threads LIBRARY GUID VR_INPUT_X VR_LOAD VR_ALONG VR_UP VR_FORCE */
#include "fmi2_host.h"
#include <pthread.h>

enum { STEPS = 40, CYCLES = 3 };

typedef struct {
    const char *guid;
    unsigned x, load, mesh[2], force;
    Component (*instantiate)(const char *, int, const char *, const char *, const Callbacks *, int, int);
    void (*free_instance)(Component);
    int (*setup)(Component, int, double, double, int, double);
    int (*enter)(Component);
    int (*leave)(Component);
    int (*set_real)(Component, const unsigned *, size_t, const double *);
    int (*get_real)(Component, const unsigned *, size_t, double *);
    int (*set_integer)(Component, const unsigned *, size_t, const int *);
    int (*step)(Component, double, double, int);
    int (*get_state)(Component, void **);
    int (*set_state)(Component, void *);
    int (*free_state)(Component, void **);
} Fmu;

typedef struct {
    const Fmu *fmu;
    double force[CYCLES][STEPS];
    int failed;
} Job;

#ifdef PLANT_A_RACE
/* Both threads set the input of one instance: what a sanitizer must find, or it sees nothing. */
static Component shared;
#endif

#define OK(call) if ((call) != 0) { job->failed = __LINE__; return NULL; }

static void *run(void *argument) {
    Job *job = argument;
    const Fmu *f = job->fmu;
    Callbacks callbacks = {logger, calloc, free, NULL, NULL};
#ifdef PLANT_A_RACE
    for (int k = 0; k < 1000; k++) {
        double newtons = k;
        OK(f->set_real(shared, &f->load, 1, &newtons));
    }
#endif
    for (int cycle = 0; cycle < CYCLES; cycle++) {
        Component block = f->instantiate("block", 1, f->guid, NULL, &callbacks, 0, 0);
        int elements[2] = {2, 2};
        double newtons = 56.25, h = 1e-5;
        void *state = NULL;
        if (!block) { job->failed = __LINE__; return NULL; }
        OK(f->set_integer(block, f->mesh, 2, elements));
        OK(f->set_real(block, &f->load, 1, &newtons));
        OK(f->setup(block, 0, 0, 0, 0, 0));
        OK(f->enter(block));
        OK(f->leave(block));
        for (int k = 0; k < STEPS; k++) {
            double position = -0.1 * k * h;
            OK(f->set_real(block, &f->x, 1, &position));
            OK(f->step(block, k * h, h, 0));
            OK(f->get_real(block, &f->force, 1, &job->force[cycle][k]));
        }
        OK(f->get_state(block, &state));
        OK(f->set_state(block, state));
        OK(f->free_state(block, &state));
        /* A refusal logs from both threads at once. */
        if (f->step(block, -1, h, 0) == 0) { job->failed = __LINE__; return NULL; }
        f->free_instance(block);
    }
    return NULL;
}

#define TAKE(member, name) *(void **)&fmu.member = dlsym(library, name); if (!fmu.member) return 10

int main(int argc, char **argv) {
    static Job jobs[2];
    pthread_t threads[2];
    Fmu fmu;
    if (argc < 8) return 2;
    void *library = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
    if (!library) { fprintf(stderr, "%s\n", dlerror()); return 9; }
    TAKE(instantiate, "fmi2Instantiate");
    TAKE(free_instance, "fmi2FreeInstance");
    TAKE(setup, "fmi2SetupExperiment");
    TAKE(enter, "fmi2EnterInitializationMode");
    TAKE(leave, "fmi2ExitInitializationMode");
    TAKE(set_real, "fmi2SetReal");
    TAKE(get_real, "fmi2GetReal");
    TAKE(set_integer, "fmi2SetInteger");
    TAKE(step, "fmi2DoStep");
    TAKE(get_state, "fmi2GetFMUstate");
    TAKE(set_state, "fmi2SetFMUstate");
    TAKE(free_state, "fmi2FreeFMUstate");
    fmu.guid = argv[2];
    fmu.x = (unsigned)atoi(argv[3]);
    fmu.load = (unsigned)atoi(argv[4]);
    fmu.mesh[0] = (unsigned)atoi(argv[5]);
    fmu.mesh[1] = (unsigned)atoi(argv[6]);
    fmu.force = (unsigned)atoi(argv[7]);
#ifdef PLANT_A_RACE
    static Callbacks callbacks = {logger, calloc, free, NULL, NULL};
    shared = fmu.instantiate("shared", 1, fmu.guid, NULL, &callbacks, 0, 0);
    if (!shared) return 14;
#endif
    for (int i = 0; i < 2; i++) {
        jobs[i].fmu = &fmu;
        if (pthread_create(&threads[i], NULL, run, &jobs[i])) return 3;
    }
    for (int i = 0; i < 2; i++) pthread_join(threads[i], NULL);
    for (int i = 0; i < 2; i++) {
        if (jobs[i].failed) { fprintf(stderr, "failed in line %d\n", jobs[i].failed); return 11; }
    }
    if (memcmp(jobs[0].force, jobs[1].force, sizeof jobs[0].force)) return 12;
    if (jobs[0].force[0][STEPS - 1] == 0) return 13;
    return 0;
}
