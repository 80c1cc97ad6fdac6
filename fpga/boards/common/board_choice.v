// Decides whether the core runs from the sensor's PIXCLK or from the PLL, and holds the core in reset around each change. It
// runs from the PLL itself, so it goes on when PIXCLK stops.
`default_nettype none

module board_choice #(
    parameter [15:0] LEAST_KHZ = 16'd4000,     // what counts as a PIXCLK
    parameter [16:0] MOST_KHZ = 17'd96100,     // the rate in the constraints, and a thousandth for both oscillators
    parameter WINDOW = 16,                     // milliseconds in which PIXCLK / 16 gives its rate in kHz; not to be changed
    parameter SETTLE = 7                       // the core's reset lasts 2 ** SETTLE link clocks on either side of a change
) (
    input  wire        link_clk,
    input  wire        link_rst,
    input  wire        link_millisecond,
    input  wire        pixclk,                 // its own buffer, in front of the choice
    input  wire        session_open,           // any clock: not under a host's feet, unless PIXCLK stops

    output reg         choose_pixclk,          // changes with the falling edge of link_clk
    output reg         hold,                   // the core is in reset
    output reg         alive,                  // PIXCLK runs and is steady
    output reg  [16:0] rate                    // kHz of PIXCLK when it was chosen
);
    reg [3:0] divided = 4'd0;
    reg       turn = 1'b0;                     // once in 16 clocks of PIXCLK

    always @(posedge pixclk) begin
        divided <= divided + 4'd1;
        turn <= turn ^ (divided == 4'd0);
    end

    wire turn_now, session;
    reg  turn_before = 1'b0;
    wire turned = turn_now != turn_before;

    board_bit turn_bit (.clk(link_clk), .level(turn), .seen(turn_now));
    board_bit session_bit (.clk(link_clk), .level(session_open), .seen(session));

    always @(posedge link_clk)
        turn_before <= turn_now;

    // Dead when 16 clocks of PIXCLK take longer than 512 of the link's, alive when two windows agree.
    reg  [8:0]  silence;
    reg  [4:0]  elapsed;
    reg  [16:0] count, measured;
    wire        dead = silence == 9'd511;
    wire        window_over = link_millisecond && elapsed == WINDOW - 1;
    wire        steady = count + 17'd64 >= measured && count <= measured + 17'd64;
    wire        in_range = count >= {1'b0, LEAST_KHZ} && count <= MOST_KHZ;

    always @(posedge link_clk)
        if (link_rst) begin
            silence <= 9'd0;
            elapsed <= 5'd0;
            count <= 17'd0;
            measured <= 17'd0;
            alive <= 1'b0;
        end else begin
            silence <= turned ? 9'd0 : dead ? silence : silence + 9'd1;
            if (link_millisecond)
                elapsed <= window_over ? 5'd0 : elapsed + 5'd1;
            count <= window_over ? 17'd0 : count + {16'd0, turned && count != 17'h1ffff};
            if (window_over)
                measured <= count;
            if (dead)
                alive <= 1'b0;
            else if (window_over)
                alive <= steady && in_range;
        end

    localparam [1:0] STAY = 2'd0, BEFORE = 2'd1, BEHIND = 2'd2;

    reg  [1:0]        state;
    reg               target;                  // to choose PIXCLK
    reg  [SETTLE-1:0] wait_count;
    wire              waited = &wait_count;

    always @(posedge link_clk)
        if (link_rst) begin
            state <= STAY;
            target <= 1'b0;
            hold <= 1'b1;
            wait_count <= {SETTLE{1'b0}};
            rate <= 17'd0;
        end else begin
            wait_count <= wait_count + 1'b1;
            case (state)
                STAY: begin
                    hold <= 1'b0;
                    wait_count <= {SETTLE{1'b0}};
                    if (target ? !alive : alive && !session) begin
                        state <= BEFORE;
                        hold <= 1'b1;
                    end
                end
                BEFORE: if (waited) begin
                    state <= BEHIND;
                    target <= alive;
                    rate <= measured;
                end
                default: if (waited)
                    state <= STAY;
            endcase
        end

    // The PLL's clock is low when this changes, so a PIXCLK that stopped low hands over without an edge.
    always @(negedge link_clk)
        if (link_rst)
            choose_pixclk <= 1'b0;
        else
            choose_pixclk <= target;
endmodule

`default_nettype wire
