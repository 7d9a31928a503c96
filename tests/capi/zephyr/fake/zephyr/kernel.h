/* The part of Zephyr's kernel that the module of odkit uses, in virtual time: `zephyr.c` of these tests has the functions. */
#ifndef FAKE_KERNEL_H
#define FAKE_KERNEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define CONFIG_ODKIT_RX_QUEUE 4
#define CONFIG_ODKIT_STORAGE 1
#define ARG_UNUSED(argument) (void)(argument)
#define BIT(number) (1u << (number))

typedef struct {
    int64_t us;
} k_timeout_t;
#define K_NO_WAIT ((k_timeout_t){0})
#define K_FOREVER ((k_timeout_t){-1})
#define K_USEC(time) ((k_timeout_t){(int64_t)(time)})

struct k_mutex {
    int locks;
};
int k_mutex_init(struct k_mutex *mutex);
int k_mutex_lock(struct k_mutex *mutex, k_timeout_t timeout);
int k_mutex_unlock(struct k_mutex *mutex);

struct k_sem {
    unsigned int count, limit;
};
int k_sem_init(struct k_sem *sem, unsigned int count, unsigned int limit);
int k_sem_take(struct k_sem *sem, k_timeout_t timeout);
void k_sem_give(struct k_sem *sem);

struct k_msgq {
    char *buffer;
    size_t size;
    uint32_t most, used;
};
void k_msgq_init(struct k_msgq *queue, char *buffer, size_t size, uint32_t most);
int k_msgq_put(struct k_msgq *queue, const void *data, k_timeout_t timeout);
int k_msgq_get(struct k_msgq *queue, void *data, k_timeout_t timeout);

typedef long atomic_t;
typedef long atomic_val_t;
atomic_val_t atomic_get(const atomic_t *target);
atomic_val_t atomic_set(atomic_t *target, atomic_val_t value);
atomic_val_t atomic_clear(atomic_t *target);

int64_t k_uptime_ticks(void);
uint64_t k_ticks_to_us_floor64(uint64_t ticks);
int32_t k_msleep(int32_t ms);
void k_panic(void);

/* A thread that the test starts: `sampling_thread`. */
#define K_THREAD_DEFINE(name, stack, entry, a, b, c, priority, options, delay) \
    extern void (*const name##_thread)(void *, void *, void *); \
    void (*const name##_thread)(void *, void *, void *) = entry

struct device {
    int number;
};
bool device_is_ready(const struct device *device);
extern const struct device the_can, the_flash;
#define DT_CHOSEN(name) name
#define zephyr_canbus the_can
#define DEVICE_DT_GET(node) (&(node))

#endif
