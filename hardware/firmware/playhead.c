#include "playhead.h"

#include "protocol.h"
#include "queue.h"

#define FULL 4096 /* of the time scale */

static uint16_t from[MAX_CHANNELS]; /* where the first key frame sets out */
static uint8_t channels;
static uint32_t elapsed; /* ticks since then */
static uint16_t scale;

void playhead_place(const uint16_t *pulses, uint8_t count)
{
    channels = count;
    for (uint8_t i = 0; i < channels; i++)
        from[i] = pulses[i];
    queue_clear(channels);
    elapsed = 0;
    scale = 0;
}

void playhead_start_at_once(void)
{
    scale = FULL;
}

bool playhead_stands(void)
{
    return scale == 0;
}

uint32_t playhead_left(void)
{
    return queue_duration() * TICKS_PER_DURATION - elapsed;
}

static void ramp(uint16_t ticks, bool go)
{
    uint16_t step = (uint16_t)((uint32_t)ticks * FULL / RAMP_TICKS);
    if (go)
        scale = FULL - scale > step ? scale + step : FULL;
    else
        scale = scale > step ? scale - step : 0;
}

uint8_t playhead_move(uint16_t ticks, bool go)
{
    uint8_t reached = 0;
    ramp(ticks, go);
    elapsed += (uint32_t)ticks * scale / FULL;
    while (!queue_is_empty()) {
        const uint16_t *key = queue_first();
        uint32_t duration = key[0] * TICKS_PER_DURATION;
        if (elapsed < duration)
            return reached;
        elapsed -= duration;
        for (uint8_t i = 0; i < channels; i++)
            from[i] = key[1 + i];
        queue_drop_first();
        reached++;
    }
    elapsed = 0;
    return reached;
}

uint16_t playhead_pulse(uint8_t channel)
{
    if (elapsed == 0)
        return from[channel];
    const uint16_t *key = queue_first();
    uint32_t duration = key[0] * TICKS_PER_DURATION, part = elapsed;
    while (duration > UINT16_MAX) { /* so that the fraction is a division of 32 bits */
        duration >>= 1;
        part >>= 1;
    }
    uint32_t fraction = (part << 16) / duration;
    int32_t way = (int32_t)key[1 + channel] - from[channel]; /* of 16 bits: its product with a fraction fits 32 */
    uint32_t gone = ((uint32_t)(way < 0 ? -way : way) * fraction + 0x8000) >> 16;
    return way < 0 ? from[channel] - (uint16_t)gone : from[channel] + (uint16_t)gone;
}
