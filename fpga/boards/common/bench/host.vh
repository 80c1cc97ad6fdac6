// The host's end of a board's link, for the boards' benches: the USB chip at its pins and a HELLO with its answer. LINK_FIFO: the chip is
// an FT2232H as asynchronous FIFO, else a UART. board_under_test.vh of the board's bench is the board.
integer    errors = 0, count = 0, i, piece, left, decoded = 0;
reg  [7:0] request [0:29];
reg  [7:0] raw [0:255], packet [0:255];
reg        asked = 0, answered = 0;              // the whole request, and its answer
reg        quiet_pins = 1;                        // the board has not driven what the chip might drive

task receive(input [7:0] value);
    begin
        answered = count != 0 && value == 0;
        raw[count] = value;
        count = count + 1;
    end
endtask

`ifdef LINK_FIFO
wire [7:0] d;
reg  [7:0] chip_data;
reg        rxf_n = 1, txe_n = 0, drive = 0;
wire       rd_n, wr_n, siwu_n;
integer    strobes = 0;

`include "board_under_test.vh"

pullup (wr_n);
pullup (siwu_n);
assign d = drive ? chip_data : 8'hzz;

// A byte goes out as the chip has it: good 14 ns behind RD#, then 49 ns without another.
task send(input [7:0] value);
    begin
        chip_data = value;
        rxf_n = 0;
        wait (!rd_n);
        #14 drive = 1;
        wait (rd_n);
        drive = 0;
        #14 rxf_n = 1;
        #49;
    end
endtask

always @(negedge wr_n) begin
    if (txe_n !== 1'b0 || drive) errors = errors + 1;
    receive(d);
    wait (wr_n);
    #14 txe_n = 1;
    #49 txe_n = 0;
end

always @(negedge siwu_n) strobes = strobes + 1;
always @(dut.ft_control_drive) if (dut.ft_control_drive === 1'b1 && !asked) quiet_pins = 0;
`else
reg        rxd = 1;
wire       txd, rts_n;
reg  [7:0] value_in;
integer    b;
localparam strobes = 1;

wire       cts_n = 1'b0;
`include "board_under_test.vh"

task send(input [7:0] value);
    integer k;
    begin
        wait (!rts_n);
        rxd = 0;
        #BAUD;
        for (k = 0; k < 8; k = k + 1) begin
            rxd = value[k];
            #BAUD;
        end
        rxd = 1;
        #BAUD;
    end
endtask

always @(negedge txd) if ($realtime > 1000) begin
    #(BAUD * 1.5);
    for (b = 0; b < 8; b = b + 1) begin
        value_in[b] = txd;
        if (b < 7) #BAUD;
    end
    #(BAUD * 0.9);
    if (txd !== 1'b1) errors = errors + 1;
    receive(value_in);
end
`endif

task field(input [8*24-1:0] what, input integer from, input integer bytes, input [63:0] due);
    reg [63:0] got;
    integer k;
    begin
        got = 0;
        for (k = 0; k < bytes; k = k + 1) got = got | packet[from + k] << (8 * k);
        if (got === due) $display("PASS %0s", what);
        else $display("FAIL %0s: %h, due %h", what, got, due);
    end
endtask

// Takes the zeros' places back; the stream is 00, the packet, 00.
task unstuff;
    begin
        left = 0;
        piece = 255;
        for (i = 0; i < count; i = i + 1)
            if (raw[i] == 0) begin
                left = 0;
                piece = 255;
            end else if (left == 0) begin
                if (piece != 255) begin packet[decoded] = 0; decoded = decoded + 1; end
                piece = raw[i];
                left = raw[i] - 1;
            end else begin
                packet[decoded] = raw[i];
                decoded = decoded + 1;
                left = left - 1;
            end
    end
endtask

// Sends HELLO, and waits for the zero behind the answer, the chip's strobe, and as long as a byte more takes.
task say_hello;
    begin
        if (count != 0) $display("FAIL bytes without a question");
        for (i = 0; i < 30; i = i + 1) send(request[i]);
        asked = 1;
        wait (answered && strobes != 0);
        #(11 * BAUD);
        unstuff;
        $display("%0s %0d bytes came back", decoded == 38 && errors == 0 ? "PASS" : "FAIL", count);
        field("a reply to HELLO", 0, 7, 56'h01_0016_0000_00_01);
        field("nonce", 12, 4, 32'h1badcafe);
        field("magic and version", 16, 5, 40'h01_31575248);
        field("build", 22, 4, 32'h12345678);
        field("the board's number", 26, 8, 64'h0123456789abcdef);
        if (led[2:1] !== 2'b11) $display("FAIL lamps %b", led);
        else $display("PASS lamps of packet and session");
        if (!quiet_pins || strobes != 1) $display("FAIL WR# and SIWU# before a packet came, %0d strobes", strobes);
        else $display("PASS the strobes of the link");
    end
endtask

initial $readmemh("protocol/vectors/hello-request.hex", request);
