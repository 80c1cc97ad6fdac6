// Stuffs packets (COBS) and puts a zero on either side of each. A code byte's place is left open in a ring until its
// run has ended; a zero becomes the place of the next code byte, so every byte costs one write and one clock.
`default_nettype none

module halfrow_stuffer (
    input  wire       clk,
    input  wire       rst,

    input  wire       in_valid,
    input  wire [7:0] in_data,
    input  wire       in_last, // with a packet's last byte
    output wire       in_ready,

    output reg        out_valid,
    output reg  [7:0] out_data,
    input  wire       out_ready,
    output wire       idle     // nothing inside
);
    localparam START = 3'd0, RUN = 3'd1, FULL = 3'd2, CLOSE = 3'd3, STOP = 3'd4;

    localparam [7:0] LONGEST = 8'd254;

    reg [2:0] state;
    reg [7:0] run;  // bytes behind the open place
    reg [8:0] open; // where the code byte will stand; everything before it is complete
    reg [8:0] tail;
    reg [8:0] head;
    reg room; // two more bytes fit
    reg running; // the state is RUN
    (* ram_style = "block" *) reg [7:0] ring [0:511];

    wire zero = in_data == 8'd0;
    wire consume = in_valid && in_ready;
    wire act = room && (in_valid || (state != START && state != RUN));
    wire coding = state == FULL || state == CLOSE || (state == RUN && zero);
    wire [8:0] used = tail - head;

    assign in_ready = room && running;
    assign idle = state == START && head == open && !out_valid;

    always @(posedge clk) begin
        if (act) ring[coding ? open : tail] <= coding ? run + 8'd1 : state == RUN ? in_data : 8'd0;
    end

    always @(posedge clk) begin
        room <= used < 9'd508;
        if (act) begin
            case (state)
                START: {open, tail} <= {tail + 9'd1, tail + 9'd2};
                FULL: {open, tail} <= {tail, tail + 9'd1};
                STOP: {open, tail} <= {tail + 9'd1, tail + 9'd1};
                RUN: begin
                    tail <= tail + 9'd1;
                    if (zero) open <= tail;
                end
                default: ;
            endcase
            run <= consume && !zero ? run + 8'd1 : 8'd0;
        end
        if (rst) begin
            room <= 1'b0;
            run <= 8'd0;
            open <= 9'd0;
            tail <= 9'd0;
        end
    end

    reg [2:0] next_state;
    always @*
        case (state)
            START: next_state = RUN;
            RUN: next_state = in_last ? CLOSE : !zero && run == LONGEST - 8'd1 ? FULL : RUN;
            FULL: next_state = RUN;
            CLOSE: next_state = STOP;
            default: next_state = START;
        endcase

    always @(posedge clk)
        if (rst) begin
            state <= START;
            running <= 1'b0;
        end else if (act) begin
            state <= next_state;
            running <= next_state == RUN;
        end

    wire fetch = head != open && (!out_valid || out_ready);

    always @(posedge clk) begin
        if (fetch) out_data <= ring[head];
    end

    always @(posedge clk) begin
        if (fetch) head <= head + 9'd1;
        if (out_ready || !out_valid) out_valid <= fetch;
        if (rst) begin
            head <= 9'd0;
            out_valid <= 1'b0;
        end
    end
endmodule

`default_nettype wire
