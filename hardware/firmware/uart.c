#include "uart.h"

#include <avr/interrupt.h>
#include <avr/io.h>

#define RING 128 /* a power of two: 5 ms of the line */

static volatile uint8_t ring[RING];
static volatile uint8_t ring_in, ring_out; /* one writer each: the interrupt, the main loop */

static uint8_t frame[LONGEST_FRAME];
static volatile uint8_t frame_at, frame_end;

void uart_start(void)
{
    UBRR0 = F_CPU / 8 / BAUD - 1;
    UCSR0A = _BV(U2X0);
    UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
    UCSR0B = _BV(RXEN0) | _BV(TXEN0) | _BV(RXCIE0);
}

ISR(USART_RX_vect)
{
    uint8_t byte = UDR0, next = (ring_in + 1) % RING;
    if (next == ring_out)
        return;
    ring[ring_in] = byte;
    ring_in = next;
}

bool uart_has_byte(void)
{
    return ring_in != ring_out;
}

bool uart_take(uint8_t *byte)
{
    if (!uart_has_byte())
        return false;
    *byte = ring[ring_out];
    ring_out = (ring_out + 1) % RING;
    return true;
}

ISR(USART_UDRE_vect)
{
    UDR0 = frame[frame_at];
    frame_at = frame_at + 1;
    if (frame_at == frame_end)
        UCSR0B &= (uint8_t)~_BV(UDRIE0);
}

bool uart_is_idle(void)
{
    return frame_at == frame_end;
}

uint8_t *uart_frame(void)
{
    return frame;
}

void uart_send(uint8_t n)
{
    frame_at = 0;
    frame_end = n;
    UCSR0B |= _BV(UDRIE0);
}
