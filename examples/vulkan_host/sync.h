/* A lock and a thread: MinGW and older Microsoft C libraries lack C11's threads.h. */
#ifndef VULKAN_HOST_SYNC_H
#define VULKAN_HOST_SYNC_H

#include <stdbool.h>

#ifdef _WIN32

#define WIN32_LEAN_AND_MEAN
#include <windows.h>

typedef SRWLOCK lock;
typedef HANDLE thread;
#define THREAD_RESULT DWORD WINAPI

static inline void lock_open(lock *l) { InitializeSRWLock(l); }
static inline void lock_close(lock *l) { (void)l; }
static inline void lock_take(lock *l) { AcquireSRWLockExclusive(l); }
static inline void lock_give(lock *l) { ReleaseSRWLockExclusive(l); }
static inline bool thread_start(thread *t, THREAD_RESULT (*run)(void *), void *user)
{
    *t = CreateThread(NULL, 0, run, user, 0, NULL);
    return *t != NULL;
}
static inline void thread_join(thread t)
{
    WaitForSingleObject(t, INFINITE);
    CloseHandle(t);
}
static inline void sleep_ms(unsigned ms) { Sleep(ms); }

#else

#include <stdlib.h>
#include <threads.h>

typedef mtx_t lock;
typedef thrd_t thread;
#define THREAD_RESULT int

static inline void lock_open(lock *l)
{
    if (mtx_init(l, mtx_plain) != thrd_success) exit(1);
}
static inline void lock_close(lock *l) { mtx_destroy(l); }
static inline void lock_take(lock *l) { mtx_lock(l); }
static inline void lock_give(lock *l) { mtx_unlock(l); }
static inline bool thread_start(thread *t, THREAD_RESULT (*run)(void *), void *user)
{
    return thrd_create(t, run, user) == thrd_success;
}
static inline void thread_join(thread t) { thrd_join(t, NULL); }
static inline void sleep_ms(unsigned ms)
{
    thrd_sleep(&(struct timespec){.tv_sec = ms / 1000, .tv_nsec = (long)(ms % 1000) * 1000000}, NULL);
}

#endif
#endif
