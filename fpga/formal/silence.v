// halfrow_session under a host that vanishes at any time: a burst ends, and its session, when no packet of it has come for the
// time that a holder may be silent, and not before. The time is a few pulses here, instead of 10,000.
`default_nettype none

module silence #(
    parameter TENTHS = 2,
    parameter MILLISECONDS = 2
) (
    input wire        clk,
    input wire        wants_reset,
    input wire        millisecond,
    input wire        wants_open,
    input wire        wants_close,
    input wire        wants_heard,
    input wire        wants_burst,
    input wire        wants_end,
    input wire        wants_rest,
    input wire [31:0] nonce,
    input wire [31:0] host
);
    localparam LONGEST = TENTHS * MILLISECONDS, BUSY = 2, SOON = BUSY + 3;

    reg running = 1'b0;
    always @(posedge clk) running <= 1'b1;
    wire rst = !running || wants_reset;

    // A packet keeps the board busy for some clocks at most; what opens and closes a session is judged meanwhile and ends a
    // burst, another one counts as it comes. None begins while a burst waits for its end.
    reg [1:0] busy;
    reg burst;
    wire silent, ends, session_open;
    wire at_rest = wants_rest || busy == BUSY;
    wire open = wants_open && !at_rest;
    wire close = wants_close && !at_rest;
    wire heard = wants_heard && session_open && at_rest && !(burst && silent);

    halfrow_session #(.TENTHS(TENTHS), .MILLISECONDS(MILLISECONDS)) dut (
        .clk(clk), .rst(rst), .millisecond(millisecond), .nonce(nonce), .host(host), .heard(heard), .greet(open),
        .open(open), .close(close), .burst(burst), .at_rest(at_rest), .silent(silent),
        .silence(ends), .session_open(session_open));

    reg [3:0] passed; // milliseconds since the host was heard
    reg [2:0] waited; // clocks behind the last of them
    reg was_over;     // the clock before ended a burst
    wire over = passed == LONGEST;
    reg over_before;  // in the clock in which `silence` was decided, behind which a packet may have come

    always @(posedge clk)
        over_before <= over && !rst;

    always @(posedge clk)
        if (rst) begin
            {busy, burst, was_over} <= 4'd0;
            passed <= 4'd0;
            waited <= 3'd0;
        end else begin
            busy <= at_rest ? 2'd0 : busy + 2'd1;
            burst <= (burst || (wants_burst && session_open && !at_rest)) && !ends && !wants_end && !open && !close;
            was_over <= ends && !open;
            passed <= heard || open ? 4'd0 : passed + (millisecond && !over);
            waited <= heard || open || !over || !burst ? 3'd0 : waited + (waited != 3'd7);
        end

    always @(posedge clk)
        if (running && !rst) begin
            in_time: assert (waited <= SOON);
            if (ends)
                not_before: assert (over || over_before);
            if (was_over)
                closed: assert (!session_open);
        end
endmodule

`default_nettype wire
