#include "queue.h"

#include "frames.h"
#include "protocol.h"

static uint16_t words[QUEUE_WORDS];
static uint8_t words_per_key = 1 + DEFAULT_CHANNELS;
static uint8_t depth, first, count;
static uint32_t duration;

void queue_clear(uint8_t channels)
{
    words_per_key = 1 + channels;
    uint16_t fit = QUEUE_WORDS / words_per_key;
    depth = fit < QUEUE_MOST ? (uint8_t)fit : QUEUE_MOST;
    first = count = 0;
    duration = 0;
}

uint8_t queue_free(void)
{
    return depth - count;
}

bool queue_is_empty(void)
{
    return count == 0;
}

uint32_t queue_duration(void)
{
    return duration;
}

static uint16_t *key_at(uint8_t index)
{
    if (index >= depth)
        index -= depth;
    return words + (uint16_t)index * words_per_key;
}

void queue_append(const uint8_t *key)
{
    uint16_t *to = key_at(first + count);
    for (uint8_t i = 0; i < words_per_key; i++)
        to[i] = get_word(key + 2 * i);
    duration += to[0];
    count++;
}

const uint16_t *queue_first(void)
{
    return key_at(first);
}

void queue_drop_first(void)
{
    duration -= key_at(first)[0];
    first = first + 1 < depth ? first + 1 : 0;
    count--;
}
