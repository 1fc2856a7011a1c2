#include "pulses.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <util/atomic.h>

#include "protocol.h"

/* The interrupt comes this long before an edge is due, and waits for the exact tick: whatever delays it (another
 * interrupt, the instruction under way) does not show on the pin. */
#define LEAD_TICKS 40

static const uint8_t mask_of[MAX_CHANNELS] = {
    _BV(PD2), _BV(PD3), _BV(PD4), _BV(PD5), _BV(PD6), _BV(PD7), _BV(PB0), _BV(PB1)
};
#define PORT_OF(channel) (*((channel) < 6 ? &PORTD : &PORTB))

static volatile uint16_t widths[MAX_CHANNELS]; /* ticks; 0: no pulse */
static volatile uint8_t channels = DEFAULT_CHANNELS;
static volatile uint16_t slot = PULSE_PERIOD_TICKS / DEFAULT_CHANNELS;
static volatile uint8_t channel; /* whose slot begins next */
static volatile uint8_t slots_begun;

static uint8_t slots_seen, slot_seen; /* by the main loop: how many, and whose the last one was */

uint16_t slot_ticks(uint8_t count)
{
    return (uint16_t)(PULSE_PERIOD_TICKS / count);
}

void pulses_start(void)
{
    DDRD |= _BV(DDD2) | _BV(DDD3) | _BV(DDD4) | _BV(DDD5) | _BV(DDD6) | _BV(DDD7);
    DDRB |= _BV(DDB0) | _BV(DDB1);
    OCR1A = slot - LEAD_TICKS;
    TIMSK1 = _BV(OCIE1A);
    TCCR1B = _BV(CS11); /* 16 MHz / 8 */
}

void pulses_divide(uint8_t count)
{
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
        channels = count;
        slot = slot_ticks(count);
        channel = slot_seen = 0;
        slots_seen = slots_begun;
    }
}

ISR(TIMER1_COMPA_vect)
{
    static uint16_t edge = PULSE_PERIOD_TICKS / DEFAULT_CHANNELS; /* when it is due */
    static uint16_t next_slot;                                    /* when that of the pulse ends */
    static uint8_t raised;
    static bool up;

    /* All is decided before the wait, so that the pin changes equally long after every tick. What is up comes down,
     * at its time, and its slot ends where it was to: channels may have been divided anew since it went up. */
    uint8_t now = up ? raised : channel, mask = mask_of[now];
    volatile uint8_t *port = &PORT_OF(now);
    uint16_t width = widths[now];
    uint8_t level = up || !width ? *port & (uint8_t)~mask : *port | mask;

    /* The flag of the other compare unit is polled in three cycles: closer than the eight of a tick. */
    OCR1B = edge;
    TIFR1 = _BV(OCF1B);
    if ((int16_t)(edge - TCNT1) > 4)
        loop_until_bit_is_set(TIFR1, OCF1B);
    *port = level;

    if (up) {
        up = false;
        edge = next_slot;
    } else {
        slots_begun++;
        next_slot = edge + slot;
        raised = now;
        channel = now + 1 < channels ? now + 1 : 0;
        up = width != 0;
        edge = up ? edge + width : next_slot;
    }
    OCR1A = edge - LEAD_TICKS;
}

bool pulses_slot_is_due(void)
{
    return slots_seen != slots_begun;
}

bool pulses_next_slot(uint8_t *next)
{
    if (!pulses_slot_is_due())
        return false;
    slots_seen++;
    slot_seen = slot_seen + 1 < channels ? slot_seen + 1 : 0;
    *next = slot_seen;
    return true;
}

void pulses_set(uint8_t which, uint16_t pulse)
{
    if (pulse && pulse < SHORTEST_PULSE)
        pulse = SHORTEST_PULSE;
    if (pulse > LONGEST_PULSE)
        pulse = LONGEST_PULSE;
    uint16_t ticks = (pulse + 4) / 8;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
        widths[which] = ticks;
    }
}
