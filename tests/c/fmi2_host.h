/* What every C host of the FMU needs: the callbacks, a logger, and the functions of the library by name. */
#ifndef FMI2_HOST_H
#define FMI2_HOST_H

#ifdef _WIN32
#include <windows.h>
#define dlopen(file, flags) LoadLibraryA(file)
#define dlsym(library, name) GetProcAddress(library, name)
#define dlerror() "LoadLibrary failed"
#else
#include <dlfcn.h>
#endif
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef void *Component;
typedef struct {
    void (*logger)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, int);
    void *environment;
} Callbacks;

/* Prints a message; counts it where the environment is a counter. */
static void logger(void *environment, const char *name, int status, const char *category,
                   const char *format, ...) {
    char text[2048];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (environment) ++*(int *)environment;
    fprintf(stderr, "%s %d %s: %s\n", name, status, category, text);
}

#define LOAD(name, type) __typeof__(type) name = (__typeof__(type))(size_t)dlsym(library, #name); if (!name) return 10
#define LOAD_OR_EXIT(name, type) __typeof__(type) name = (__typeof__(type))(size_t)dlsym(library, #name); if (!name) exit(10)
#endif
