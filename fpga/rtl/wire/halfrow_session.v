// Who has the board: the open session's number, the HELLO that opened it, and how long its holder may still be silent.
`default_nettype none

module halfrow_session #(
    // how long a holder may be silent, other than in proofs
    parameter TENTHS = 100,
    parameter MILLISECONDS = 100 // of a tenth
) (
    input  wire        clk,
    input  wire        rst,
    input  wire        millisecond, // pulse, once a millisecond
    input  wire [31:0] nonce,       // of a HELLO, stable two clocks before `greet`
    input  wire [31:0] host,
    input  wire        heard,       // pulse: a packet of the open session came
    input  wire        greet,       // pulse: a HELLO came
    input  wire        open,        // pulse: the HELLO opens a session
    input  wire        close,       // pulse
    output wire        repeated,    // the HELLO is the one that opened the session
    output wire        held,        // another host has the board
    output reg  [6:0]  tenths_left, // of the holder's ten seconds, rounded up
    input  wire        burst,       // one is under way, which they end
    input  wire        at_rest,     // no packet is carried out
    output wire        silent,      // they have passed
    output reg         silence,     // pulse: the burst ends, and the session
    output reg         session_open,
    output wire [7:0]  session      // 0 for none
);
    localparam [6:0] LAST_OF_TENTH = MILLISECONDS[6:0] - 7'd1;
    localparam [7:0] GREATEST = 8'd255;

    reg [7:0] number;
    reg [31:0] holder_nonce, holder_host;
    wire nonce_fits, host_fits;
    reg same_nonce, same_host;
    reg [6:0] milliseconds;
    reg counting; // tenths_left is not 0

    assign silent = !counting;
    assign session = session_open ? number : 8'd0;
    assign repeated = session_open && same_nonce && same_host;
    assign held = session_open && !same_host && counting;

    halfrow_equal #(.WIDTH(32)) nonces (.clk(clk), .a(nonce), .b(holder_nonce), .equal(nonce_fits));
    halfrow_equal #(.WIDTH(32)) hosts (.clk(clk), .a(host), .b(holder_host), .equal(host_fits));

    always @(posedge clk)
        {same_nonce, same_host} <= {nonce_fits, host_fits};

    always @(posedge clk)
        if (open) begin
            holder_nonce <= nonce;
            holder_host <= host;
        end

    always @(posedge clk)
        silence <= burst && silent && at_rest && !rst;

    always @(posedge clk) begin
        if (rst) begin
            session_open <= 1'b0;
            number <= 8'd0;
        end else if (open) begin
            session_open <= 1'b1;
            number <= number == GREATEST ? 8'd1 : number + 8'd1;
        end else if (close || silence) begin
            session_open <= 1'b0;
        end
    end

    always @(posedge clk) begin
        if (rst || heard || open || (greet && same_host)) begin
            tenths_left <= TENTHS[6:0];
            milliseconds <= 7'd0;
            counting <= 1'b1;
        end else if (millisecond && counting) begin
            milliseconds <= milliseconds == LAST_OF_TENTH ? 7'd0 : milliseconds + 7'd1;
            if (milliseconds == LAST_OF_TENTH) begin
                tenths_left <= tenths_left - 7'd1;
                counting <= tenths_left != 7'd1;
            end
        end
    end
endmodule

`default_nettype wire
