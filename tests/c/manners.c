/* What a host must find as it left it, on the odd paths that hosts take: threads with small stacks, an
 * instance made, stepped and freed by different threads, another rounding mode, the library unloaded and
 * loaded again. Built with gcc -Wall -Wextra -Werror, run plain and under AddressSanitizer.
 *
 *   manners LIBRARY GUID VR_INPUT_X VR_LOAD VR_ALONG VR_UP VR_FORCE */
#define _GNU_SOURCE
#include "fmi2_host.h"
#include <fenv.h>
#include <locale.h>
#include <pthread.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xmmintrin.h>

enum { STEPS = 40, LOADS = 20, SMALL_STACK = 128 * 1024 };

typedef struct {
    unsigned mxcsr;
    unsigned short x87;
    char folder[1024], locale[64];
    mode_t umask;
    struct sigaction handlers[NSIG];
    sigset_t blocked;
} Host;

/* The exception flags of the control word are everybody's; masks, rounding and flushing are the host's. */
static void look(Host *host) {
    memset(host, 0, sizeof *host);
    host->mxcsr = _mm_getcsr() & ~0x3fu;
    __asm__ volatile("fnstcw %0" : "=m"(host->x87));
    if (!getcwd(host->folder, sizeof host->folder)) exit(3);
    strncpy(host->locale, setlocale(LC_ALL, NULL), sizeof host->locale - 1);
    host->umask = umask(0);
    umask(host->umask);
    for (int s = 1; s < NSIG; s++) sigaction(s, NULL, &host->handlers[s]);
    pthread_sigmask(SIG_SETMASK, NULL, &host->blocked);
}

static const char *guid;
static unsigned x, load, mesh[2], force;
static void *library;
static int messages;
static Callbacks callbacks = {logger, calloc, free, NULL, &messages};

#define OK(call) if ((call) != 0) { fprintf(stderr, "failed: %s\n", #call); exit(11); }

static void *make(void *unused) {
    (void)unused;
    LOAD_OR_EXIT(fmi2Instantiate, Component (*)(const char *, int, const char *, const char *, const Callbacks *, int, int));
    LOAD_OR_EXIT(fmi2SetInteger, int (*)(Component, const unsigned *, size_t, const int *));
    LOAD_OR_EXIT(fmi2SetReal, int (*)(Component, const unsigned *, size_t, const double *));
    LOAD_OR_EXIT(fmi2SetupExperiment, int (*)(Component, int, double, double, int, double));
    LOAD_OR_EXIT(fmi2EnterInitializationMode, int (*)(Component));
    LOAD_OR_EXIT(fmi2ExitInitializationMode, int (*)(Component));
    Component block = fmi2Instantiate("block", 1, guid, NULL, &callbacks, 0, 0);
    int elements[2] = {3, 2};
    double newtons = 56.25;
    if (!block) exit(12);
    OK(fmi2SetInteger(block, mesh, 2, elements));
    OK(fmi2SetReal(block, &load, 1, &newtons));
    OK(fmi2SetupExperiment(block, 0, 0, 0, 0, 0));
    OK(fmi2EnterInitializationMode(block));
    OK(fmi2ExitInitializationMode(block));
    return block;
}

static double last;

static void *slide(void *block) {
    LOAD_OR_EXIT(fmi2SetReal, int (*)(Component, const unsigned *, size_t, const double *));
    LOAD_OR_EXIT(fmi2GetReal, int (*)(Component, const unsigned *, size_t, double *));
    LOAD_OR_EXIT(fmi2DoStep, int (*)(Component, double, double, int));
    const double h = 1e-5;
    for (int k = 0; k < STEPS; k++) {
        double position = -0.1 * k * h;
        OK(fmi2SetReal(block, &x, 1, &position));
        OK(fmi2DoStep(block, k * h, h, 0));
    }
    OK(fmi2GetReal(block, &force, 1, &last));
    return NULL;
}

static void *release(void *block) {
    LOAD_OR_EXIT(fmi2FreeInstance, void (*)(Component));
    fmi2FreeInstance(block);
    return NULL;
}

/* Runs `work` on a thread with a small stack. */
static void *elsewhere(void *(*work)(void *), void *argument) {
    pthread_attr_t attributes;
    pthread_t thread;
    void *result = NULL;
    pthread_attr_init(&attributes);
    if (pthread_attr_setstacksize(&attributes, SMALL_STACK)) exit(4);
    if (pthread_create(&thread, &attributes, work, argument)) exit(5);
    pthread_join(thread, &result);
    pthread_attr_destroy(&attributes);
    return result;
}

/* Compared field by field: what lies between them is nobody's. */
static const char *changed(const Host *a, const Host *b) {
    if (a->mxcsr != b->mxcsr || a->x87 != b->x87) return "floating point control word";
    if (strcmp(a->folder, b->folder)) return "working directory";
    if (strcmp(a->locale, b->locale)) return "locale";
    if (a->umask != b->umask) return "umask";
    for (int s = 1; s < NSIG; s++) {
        if (a->handlers[s].sa_handler != b->handlers[s].sa_handler) return "signal handlers";
        if (sigismember(&a->blocked, s) != sigismember(&b->blocked, s)) return "signal mask";
    }
    return NULL;
}

/* The force at the end of a passage, in this thread; the host is as it was. */
static double passage(void) {
    Host before, after;
    look(&before);
    Component block = make(NULL);
    slide(block);
    release(block);
    look(&after);
    const char *what = changed(&before, &after);
    if (what) { fprintf(stderr, "the host was changed: %s\n", what); exit(13); }
    return last;
}

int main(int argc, char **argv) {
    if (argc < 8) return 2;
    guid = argv[2];
    x = (unsigned)atoi(argv[3]);
    load = (unsigned)atoi(argv[4]);
    mesh[0] = (unsigned)atoi(argv[5]);
    mesh[1] = (unsigned)atoi(argv[6]);
    force = (unsigned)atoi(argv[7]);
    double first = 0;
    for (int k = 0; k < LOADS; k++) {
        library = dlopen(argv[1], RTLD_NOW | (k % 2 ? RTLD_GLOBAL : RTLD_LOCAL));
        if (!library) { fprintf(stderr, "%s\n", dlerror()); return 9; }
        double now = passage();
        if (k == 0) first = now;
        if (memcmp(&now, &first, sizeof now)) return 14;
        dlclose(library);
    }
    library = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
    Component block = elsewhere(make, NULL);
    elsewhere(slide, block);
    elsewhere(release, block);
    if (memcmp(&last, &first, sizeof last)) return 15;
    /* A host's own rounding and flushing is kept, and moves the result by no more than rounding does. */
    setlocale(LC_ALL, "");
    fesetround(FE_UPWARD);
    _mm_setcsr(_mm_getcsr() | 0x8040); /* flush to zero, denormals are zero */
    double upward = passage();
    fesetround(FE_TONEAREST);
    if (!(upward > first - 1e-6 && upward < first + 1e-6)) return 16;
    printf("%.17g %.17g\n", first, upward);
    return messages ? 17 : 0; /* nothing went wrong, so nothing was told */
}
