/* Loads the library named by the first argument at run time, finds every function named by the others, calls one, and
 * unloads it. */
#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>

typedef int32_t (*version_fn)(uint32_t *, uint32_t *, uint32_t *);

int main(int argc, char **argv)
{
    uint32_t major = 99;
    version_fn version = NULL;
    int i;
    void *library = argc > 1 ? dlopen(argv[1], RTLD_NOW | RTLD_LOCAL) : NULL;
    if (!library) {
        fprintf(stderr, "%s\n", argc > 1 ? dlerror() : "which library?");
        return 1;
    }
    for (i = 2; i < argc; i++) {
        if (!dlsym(library, argv[i])) {
            fprintf(stderr, "%s is missing\n", argv[i]);
            return 1;
        }
    }
    *(void **)&version = dlsym(library, "wk_version");
    if (!version || version(&major, NULL, NULL) != 0 || major == 99) return 1;
    if (dlclose(library) != 0) return 1;
    printf("%d functions\n", argc - 2);
    return 0;
}
