#include "machine.h"

#include <string.h>

#include "frames.h"
#include "playhead.h"
#include "protocol.h"
#include "pulses.h"
#include "queue.h"
#include "record.h"

struct channel {
    uint16_t shortest, longest, park; /* 1/16 us */
};

static enum state state;
static enum fault fault;

static uint8_t channels;
static uint16_t slot; /* ticks */
static struct channel channel_of[MAX_CHANNELS];
static bool configured;

static uint16_t pose[MAX_CHANNELS]; /* the pulses set last */
static uint8_t attached;            /* channels that have pulses: the first so many */
static uint32_t attach_in;          /* ticks until the next one */
static uint32_t silence;            /* ticks since a good frame */

static uint16_t session;               /* 0 from a reset until a HELLO */
static uint8_t order_type, order_seq;  /* the last order, so that it is done once however often it comes */
static enum result order_result;
static uint8_t expected; /* sequence number of the key frame to come */
static bool ended;       /* what is queued is the end of the motion */
static uint8_t reached_in[MAX_CHANNELS + 1]; /* key frames whose end was reached in each of the last slots */
static uint8_t slot_at;
static bool gap, tell_info, tell_record, tell_status;

static void divide(uint8_t count)
{
    channels = count;
    slot = slot_ticks(count);
    pulses_divide(count);
    queue_clear(count);
}

void machine_start(void)
{
    divide(DEFAULT_CHANNELS);
    record_start();
    tell_status = true; /* with session 0: whoever was playing learns of the reset */
}

static void enter(enum state next)
{
    state = next;
    tell_status = true;
}

/* Stand where the pulses are, and forget what is queued, and what was reached and no servo will be told of. */
static void flush(void)
{
    playhead_place(pose, channels);
    memset(reached_in, 0, sizeof reached_in);
    ended = false;
}

static void fail(enum fault why)
{
    fault = why;
    flush();
    enter(STATE_FAULT);
}

static void clear(void)
{
    flush();
    fault = FAULT_NONE;
    expected = 0;
    enter(attached == 0 ? STATE_OFF : attached < channels ? STATE_ARMING : STATE_READY);
}

static enum result hello(const uint8_t *payload, uint8_t n)
{
    if (n != 2 || get_word(payload) == 0)
        return REFUSED_LENGTH;
    if (session != get_word(payload)) { /* another host, or the same started anew: nothing of before counts */
        session = get_word(payload);
        record_begin(session);
        if (state == STATE_FAULT)
            expected = 0; /* and stays one until it is cleared */
        else
            clear();
    }
    tell_info = true;
    return DONE;
}

/* Longest pulse, in 1/16 us, that ends before the next channel's slot. */
static uint16_t longest_in_slot(uint8_t count)
{
    uint16_t room_us = slot_ticks(count) / 2 - SLOT_MARGIN_US;
    return room_us < LONGEST_PULSE / 16 ? room_us * 16 : LONGEST_PULSE;
}

static enum result config(const uint8_t *payload, uint8_t n)
{
    uint8_t count = n / sizeof(struct channel);
    struct channel wanted[MAX_CHANNELS];
    if (count == 0 || count > MAX_CHANNELS || n % sizeof(struct channel))
        return REFUSED_LENGTH;
    for (uint8_t i = 0; i < count; i++, payload += sizeof(struct channel)) {
        struct channel one = { get_word(payload), get_word(payload + 2), get_word(payload + 4) };
        if (one.shortest < SHORTEST_PULSE || one.shortest > one.park || one.park > one.longest
                || one.longest > longest_in_slot(count))
            return REFUSED_RANGE;
        wanted[i] = one;
    }
    if (state != STATE_OFF) /* moving servos keep the ranges that they were attached with */
        return configured && count == channels && !memcmp(wanted, channel_of, n) ? DONE : REFUSED_STATE;
    memcpy(channel_of, wanted, n);
    divide(count);
    configured = true;
    return DONE;
}

static bool in_range(const uint8_t *pulses)
{
    for (uint8_t i = 0; i < channels; i++) {
        uint16_t pulse = get_word(pulses + 2 * i);
        if (pulse < channel_of[i].shortest || pulse > channel_of[i].longest)
            return false;
    }
    return true;
}

static enum result arm(const uint8_t *payload, uint8_t n)
{
    if (state != STATE_OFF || !configured)
        return REFUSED_STATE;
    if (n != 0 && n != 2 * channels)
        return REFUSED_LENGTH;
    if (n && !in_range(payload))
        return REFUSED_RANGE;
    for (uint8_t i = 0; i < channels; i++)
        pose[i] = n ? get_word(payload + 2 * i) : channel_of[i].park;
    flush();
    attach_in = 0;
    enter(STATE_ARMING);
    return DONE;
}

static enum result start(void)
{
    switch (state) {
    case STATE_READY:
        if (queue_is_empty())
            return REFUSED_EMPTY;
        playhead_start_at_once();
        /* fall through */
    case STATE_HOLD:
    case STATE_UNDERRUN:
        enter(STATE_RUN);
        return DONE;
    case STATE_RUN:
        return DONE;
    default:
        return REFUSED_STATE;
    }
}

static enum result hold(void)
{
    if (state != STATE_RUN && state != STATE_HOLD)
        return REFUSED_STATE;
    enter(STATE_HOLD);
    return DONE;
}

static enum result off(void)
{
    if (state != STATE_OFF && state != STATE_READY)
        return REFUSED_STATE;
    for (uint8_t i = 0; i < channels; i++)
        pulses_set(i, 0);
    attached = 0;
    flush();
    enter(STATE_OFF);
    return DONE;
}

static enum result obey(uint8_t type, const uint8_t *payload, uint8_t n)
{
    switch (type) {
    case HELLO:
        return hello(payload, n);
    case CONFIG:
        return config(payload, n);
    case ARM:
        return arm(payload, n);
    }
    if (type > RECALL)
        return REFUSED_TYPE;
    if (n != 0)
        return REFUSED_LENGTH;
    switch (type) {
    case START:
        return start();
    case HOLD:
        return hold();
    case STOP:
        fail(FAULT_STOPPED);
        return DONE;
    case CLEAR:
        clear();
        return DONE;
    case OFF:
        return off();
    case RECALL:
        tell_record = true;
        return DONE;
    case PING:
        return DONE;
    }
    return REFUSED_TYPE;
}

/* A sequenced frame: only the one expected, and only where it can be played. */
static void sequenced(uint8_t type, uint8_t seq, const uint8_t *payload, uint8_t n)
{
    if (state != STATE_READY && state != STATE_RUN && state != STATE_HOLD && state != STATE_UNDERRUN)
        return;
    if (seq != expected) {
        gap |= (uint8_t)(seq - expected) < 128; /* one that came before is here already: nothing is missing */
        return;
    }
    if (type == END) {
        if (n != 0) {
            fail(FAULT_BAD_KEY);
            return;
        }
        ended = true;
    } else {
        if (n != 2 + 2 * channels || get_word(payload) == 0 || !in_range(payload + 2)) {
            fail(FAULT_BAD_KEY);
            return;
        }
        if (queue_free() == 0) /* the host overdrew its credits: it will have to send this one again */
            return;
        queue_append(payload);
        ended = false;
    }
    expected++;
}

void machine_receive(const uint8_t *body, uint8_t n)
{
    uint8_t type = body[0], seq = body[1];
    silence = 0;
    tell_status = true;
    if (type == KEY || type == END) {
        sequenced(type, seq, body + 2, n - 2);
        return;
    }
    /* An order that comes again because its answer got lost is not obeyed again. HELLO, STOP, CLEAR and RECALL are:
     * they lead to the same however often, and have to work whatever went before. */
    if (type != HELLO && type != STOP && type != CLEAR && type != RECALL && type == order_type && seq == order_seq)
        return;
    order_result = obey(type, body + 2, n - 2);
    order_type = type;
    order_seq = seq;
}

void machine_receive_damaged(void)
{
    gap = tell_status = true;
}

static void attach(void)
{
    if (attach_in > slot) {
        attach_in -= slot;
    } else if (attached < channels) {
        attached++;
        attach_in = ATTACH_TICKS;
    } else {
        enter(STATE_READY);
    }
}

/* A key frame counts as played once every servo has had a pulse, and had it whole, since its end was reached: that is
 * where the arm stands if it is stopped or reset now. */
static void count_played(void)
{
    slot_at = slot_at < channels ? slot_at + 1 : 0;
    uint8_t more = reached_in[slot_at];
    reached_in[slot_at] = 0;
    if (more) {
        record_played(more);
        tell_status = true;
    }
}

static void play(void)
{
    /* Where the host has fallen silent it brakes along what is left, and does not run into the end of it. */
    bool go = state == STATE_RUN && (ended || playhead_left() > RESERVE_TICKS);
    reached_in[slot_at] = playhead_move(slot, go);
    if (state != STATE_RUN)
        return;
    if (queue_is_empty() && ended)
        enter(STATE_READY);
    else if (queue_is_empty() || (!go && playhead_stands()))
        enter(STATE_UNDERRUN);
}

void machine_slot(uint8_t channel)
{
    bool moving = state == STATE_RUN || state == STATE_HOLD;
    if (moving || state == STATE_UNDERRUN) {
        silence += slot;
        if (silence > SILENCE_TICKS) {
            fail(FAULT_SILENCE);
            return;
        }
    }
    count_played();
    if (state == STATE_ARMING)
        attach();
    if (moving)
        play();
    if (state != STATE_FAULT && channel < attached) {
        pose[channel] = playhead_pulse(channel);
        pulses_set(channel, pose[channel]);
    }
}

bool machine_has_answer(void)
{
    return tell_info || tell_record || tell_status;
}

uint8_t machine_answer(uint8_t *body)
{
    body[1] = order_seq;
    put_word(body + 2, session);
    if (tell_info) {
        tell_info = false;
        body[0] = INFO;
        body[4] = PROTOCOL_VERSION;
        body[5] = FIRMWARE_MAJOR;
        body[6] = FIRMWARE_MINOR;
        body[7] = MAX_CHANNELS;
        put_word(body + 8, SHORTEST_PULSE);
        put_word(body + 10, LONGEST_PULSE);
        for (uint8_t i = 0; i < attached; i++)
            put_word(body + 12 + 2 * i, pose[i]);
        return 12 + 2 * attached;
    }
    if (tell_record) {
        tell_record = false;
        body[0] = RECORD;
        put_word(body + 2, record_session());
        put_long(body + 4, record_keys());
        body[8] = state;
        return 9;
    }
    body[0] = STATUS;
    body[4] = state;
    body[5] = fault;
    body[6] = order_result;
    body[7] = expected;
    body[8] = queue_free();
    body[9] = gap ? FLAG_GAP : 0;
    put_long(body + 10, record_keys());
    tell_status = gap = false;
    return 14;
}
